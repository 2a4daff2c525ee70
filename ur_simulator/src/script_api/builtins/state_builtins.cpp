#include "common/pose.hpp"
#include "kinematics/forward_kinematics.hpp"
#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

struct StateGetter {
  const char * name;
  Value (*read)(const ControllerState & state);
};

constexpr StateGetter state_getters[] = {
    {"get_actual_joint_positions",
     [](const ControllerState & s) { return Value::list(s.measured.position); }},
    // A former name, which UR's External Control program uses.
    {"get_joint_positions", [](const ControllerState & s) { return Value::list(s.measured.position); }},
    {"get_actual_joint_accelerations",
     [](const ControllerState & s) { return Value::list(s.actual.acceleration); }},
    {"get_actual_joint_speeds", [](const ControllerState & s) { return Value::list(s.actual.velocity); }},
    {"get_actual_tcp_pose", [](const ControllerState & s) { return Value::pose(s.measured.tcp_pose); }},
    {"get_actual_tcp_speed", [](const ControllerState & s) { return Value::pose(s.actual_tcp_speed); }},
    {"get_target_joint_positions", [](const ControllerState & s) { return Value::list(s.target.position); }},
    {"get_target_joint_speeds", [](const ControllerState & s) { return Value::list(s.target.velocity); }},
    {"get_target_joint_accelerations",
     [](const ControllerState & s) { return Value::list(s.target.acceleration); }},
    {"get_target_tcp_pose", [](const ControllerState & s) { return Value::pose(s.target_tcp_pose); }},
    {"get_target_tcp_speed", [](const ControllerState & s) { return Value::pose(s.target_tcp_speed); }},
    {"get_target_tcp_pose_along_path",
     [](const ControllerState & s) { return Value::pose(s.path_tcp_pose); }},
    {"get_target_tcp_speed_along_path",
     [](const ControllerState & s) { return Value::pose(s.path_tcp_speed); }},
    {"get_tcp_force", [](const ControllerState & s) { return Value::pose(s.reported_tcp_force); }},
    {"get_tcp_offset", [](const ControllerState & s) { return Value::pose(s.tcp_offset); }},
    {"get_tool_accelerometer_reading",
     [](const ControllerState & s) { return Value::list(s.measured.tool_acceleration); }},
    {"get_tool_current", [](const ControllerState & s) { return Value(s.io.tool_output_current); }},
    {"get_tool_temp", [](const ControllerState & s) { return Value(s.io.tool_temperature); }},
    {"get_gravity", [](const ControllerState & s) { return Value::list(s.gravity); }},
    {"force", [](const ControllerState & s) { return Value(s.actual_tcp_force.head<3>().norm()); }},
    {"is_steady", [](const ControllerState & s) { return Value(s.steady); }},
    {"get_target_payload", [](const ControllerState & s) { return Value(s.payload.mass); }},
    {"get_target_payload_cog",
     [](const ControllerState & s) { return Value::list(s.payload.center_of_gravity); }},
    {"get_target_payload_inertia", [](const ControllerState & s) { return Value::list(s.payload.inertia); }},
    // Constant: there is no thermal model of the cabinet.
    {"get_controller_temp", [](const ControllerState &) { return Value(25.0); }},
};

Outcome history(const RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t steps = reader.integer(0, "steps");
  reader.require(steps >= 0, fmt::format("steps must not be negative, is {}", steps));
  if (!reader) {
    return reader.failure();
  }
  if (steps == 0) {
    return Value::list(robot.state().measured.position);
  }
  const JointHistory * history = robot.access.history;
  const auto position =
      history == nullptr ? std::nullopt : history->position(static_cast<std::size_t>(steps));
  if (!position) {
    return Failure{fmt::format("the joint positions of {} steps ago are not stored", steps)};
  }
  return Value::list(*position);
}

Outcome joint_temperature(const RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::int32_t joint = reader.integer(0, "j");
  reader.require(joint >= 0 && joint < 6, fmt::format("j must be in [0, 5], is {}", joint));
  return reader ? Outcome(Value(robot.state().joint_temperatures[joint])) : reader.failure();
}

// Joint torques caused by external forces, without the weight and the motion of the arm.
Vector6 external_torques(const RobotContext & robot)
{
  const ControllerState & state = robot.state();
  return jacobian(robot.access.model, state.actual.position, state.tcp_offset).transpose() *
         state.actual_tcp_force;
}

}  // namespace

void add_state_builtins(Library & library, const RobotContextPtr & robot)
{
  for (const StateGetter & getter : state_getters) {
    library.add({getter.name, {}, 0, [robot, read = getter.read](CallContext &, Arguments) -> Outcome {
                   return read(robot->state());
                 }});
  }
  library.add({"get_actual_joint_positions_history",
               {{"steps", Value(0)}},
               0,
               [robot](CallContext &, Arguments arguments) { return history(*robot, arguments); }});
  library.add({"get_joint_temp", {"j"}, 1, [robot](CallContext &, Arguments arguments) {
                 return joint_temperature(*robot, arguments);
               }});
  library.add({"get_actual_tool_flange_pose", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value::pose(
                     to_pose(flange_pose(robot->access.model, robot->state().actual.position)));
               }});
  library.add({"get_joint_torques", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value::list(external_torques(*robot));
               }});
  library.add({"get_steptime", {}, 0, [robot](CallContext &, Arguments) -> Outcome {
                 return Value(robot->access.cycle_time);
               }});
  library.simplify("get_controller_temp", "always 25 °C");
  library.simplify("get_joint_temp", "constant: joints do not warm up");
  library.simplify("get_tool_temp", "constant: the tool does not warm up");
  library.simplify("get_joint_torques", "torques caused by the force at the TCP");
}

}  // namespace ur_simulator::script_api
