#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

/// rad/s. The servo approaches its target exponentially: for 15 ms after a motion, the joints still move,
/// more slowly than the sensors of a robot can resolve.
constexpr double standstill_speed = 1e-3;

template <typename Derived>
json to_json_array(const Eigen::MatrixBase<Derived> & values)
{
  json result = json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    result.push_back(static_cast<double>(values[i]));
  }
  return result;
}

json joints_to_json(const JointState & joints)
{
  return {{"position", to_json_array(joints.position)},
          {"velocity", to_json_array(joints.velocity)},
          {"acceleration", to_json_array(joints.acceleration)},
          {"current", to_json_array(joints.current)},
          {"torque", to_json_array(joints.torque)}};
}

json payload_to_json(const Payload & payload)
{
  return {{"mass", payload.mass}, {"center_of_gravity", to_json_array(payload.center_of_gravity)}};
}

json tool_communication_to_json(const ToolCommunication & line)
{
  return {{"enabled", line.enabled},
          {"baud_rate", line.baud_rate},
          {"parity", line.parity},
          {"stop_bits", line.stop_bits},
          {"rx_idle_chars", line.rx_idle_chars},
          {"tx_idle_chars", line.tx_idle_chars}};
}

json io_to_json(const Io & io)
{
  return {{"digital_inputs", io.digital_inputs},
          {"digital_outputs", io.digital_outputs},
          {"analog_inputs", io.analog_inputs},
          {"analog_outputs", io.analog_outputs},
          {"analog_io_types", io.analog_io_types},
          {"tool_analog_inputs", io.tool_analog_inputs},
          {"tool_output_voltage", io.tool_output_voltage},
          {"tool_output_mode", io.tool_output_mode},
          {"tool_digital_output_modes", io.tool_digital_output_modes},
          {"tool_analog_input_types", io.tool_analog_input_types},
          {"tool_communication", tool_communication_to_json(io.tool_communication)}};
}

json lapses_to_json(const MotionLapses & lapses)
{
  return {{"broken_off", lapses.broken_off}, {"moves_from_motion", lapses.moves_from_motion}};
}

json program_to_json(const ControlPortContext & context)
{
  const ProgramRunner & runner = context.pendant.runner();
  return {{"state", to_string(context.state.runtime_state)},
          {"name", runner.program_name()},
          {"loaded", context.pendant.loaded_program()},
          {"threads", runner.machine() != nullptr ? runner.machine()->thread_count() : 0},
          {"instructions", runner.machine() != nullptr ? runner.machine()->instructions() : 0}};
}

json clients_to_json(const ControlPortContext & context)
{
  json result;
  for (const auto & [name, listener] : context.listeners) {
    result[name] = listener->connection_count();
  }
  result["rtde_control"] = context.rtde.client_count(rtde::ClientRole::control);
  result["rtde_receive"] = context.rtde.client_count(rtde::ClientRole::receive);
  result["rtde_io"] = context.rtde.client_count(rtde::ClientRole::io);
  result["rtde_dropped_packages"] = context.rtde.dropped_packages();
  return result;
}

json gripper_to_json(const SoftGripper * gripper)
{
  if (gripper == nullptr) {
    return nullptr;
  }
  return {{"width", gripper->width()}, {"target", gripper->target()}, {"busy", gripper->is_busy()}};
}

json robotiq_gripper_to_json(const RobotiqGripper * gripper)
{
  if (gripper == nullptr) {
    return nullptr;
  }
  json result{{"width", gripper->width()}, {"powered", gripper->is_powered()}};
  for (const char * name : {"ACT", "GTO", "STA", "POS", "PRE", "OBJ", "FLT", "SPE", "FOR"}) {
    result[name] = *gripper->get(name);
  }
  return result;
}

json surfaces_to_json(const World & world)
{
  json result = json::array();
  for (const auto & [id, surface] : world.surfaces()) {
    result.push_back(
        {{"id", id}, {"point", to_json_array(surface.point)}, {"normal", to_json_array(surface.normal)}});
  }
  return result;
}

json boxes_to_json(const World & world)
{
  json result = json::array();
  for (const auto & [id, box] : world.boxes()) {
    result.push_back({{"id", id},
                      {"center", to_json_array(box.center)},
                      {"size", to_json_array(box.size)},
                      {"rotation", to_json_array(box.rotation)}});
  }
  return result;
}

json springs_to_json(const World & world)
{
  json result = json::array();
  for (const auto & [id, spring] : world.springs()) {
    result.push_back({{"id", id},
                      {"anchor", to_json_array(spring.anchor)},
                      {"stiffness", spring.stiffness},
                      {"length", spring.length}});
  }
  return result;
}

void add_robot(json & result, const ControlPortContext & context)
{
  const ControllerState & s = context.state;
  const Pendant & pendant = context.pendant;
  const auto & popup = context.pendant.runner().popup();
  const auto * request = context.pendant.runner().value_request();
  const auto & safety_popup = pendant.safety_popup();
  result.update({{"cycle", s.cycle},
                 {"timestamp", s.timestamp},
                 {"missed_cycles", context.missed_cycles},
                 {"model", pendant.model().name},
                 {"polyscope", pendant.options().version.to_string()},
                 {"robot_mode", to_string(s.robot_mode)},
                 {"safety_mode", to_string(s.safety_mode)},
                 {"robot_status_bits", s.robot_status_bits},
                 {"safety_status_bits", s.safety_status_bits},
                 {"remote_control", pendant.remote_control()},
                 {"program", program_to_json(context)},
                 {"popup", popup ? json(popup->message) : json(nullptr)},
                 {"value_request", request != nullptr ? json(request->message) : json(nullptr)},
                 {"safety_popup", safety_popup ? json(*safety_popup) : json(nullptr)},
                 {"surfaces", surfaces_to_json(context.world)},
                 {"boxes", boxes_to_json(context.world)},
                 {"springs", springs_to_json(context.world)},
                 {"gripper", gripper_to_json(context.world.gripper())},
                 {"robotiq_gripper", robotiq_gripper_to_json(context.world.robotiq_gripper())},
                 {"io", io_to_json(s.io)},
                 {"clients", clients_to_json(context)},
                 {"actual_execution_time", s.actual_execution_time}});
}

void add_motion(json & result, const ControlPortContext & context)
{
  const ControllerState & s = context.state;
  result.update({{"target", joints_to_json(s.target)},
                 {"actual", joints_to_json(s.actual)},
                 {"target_tcp_pose", to_json_array(s.target_tcp_pose)},
                 {"target_tcp_speed", to_json_array(s.target_tcp_speed)},
                 {"actual_tcp_pose", to_json_array(s.actual_tcp_pose)},
                 {"actual_tcp_speed", to_json_array(s.actual_tcp_speed)},
                 {"actual_tcp_force", to_json_array(s.actual_tcp_force)},
                 {"contact_wrench", to_json_array(s.contact_wrench)},
                 {"tcp_offset", to_json_array(s.tcp_offset)},
                 {"payload", payload_to_json(s.payload)},
                 {"speed_slider", s.speed_slider},
                 {"speed_scaling", s.speed_scaling},
                 {"at_rest", context.arm.at_rest(standstill_speed)},
                 {"steady", s.steady},
                 {"freedrive", s.freedrive},
                 {"force_mode", context.arm.in_force_mode()},
                 {"lapses", lapses_to_json(s.lapses)},
                 {"external_sensor", s.external_sensor.enabled}});
}

}  // namespace

json state_to_json(const ControlPortContext & context)
{
  json result;
  add_robot(result, context);
  add_motion(result, context);
  return result;
}

}  // namespace ur_simulator::control_port
