#include <array>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

template <typename Derived>
json array(const Eigen::MatrixBase<Derived> & values)
{
  json result = json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    result.push_back(static_cast<double>(values[i]));
  }
  return result;
}

json joints(const JointState & state)
{
  return {{"position", array(state.position)},
          {"velocity", array(state.velocity)},
          {"acceleration", array(state.acceleration)},
          {"current", array(state.current)},
          {"torque", array(state.torque)}};
}

std::string_view name(RuntimeState state)
{
  constexpr std::array<std::string_view, 6> names{"STOPPING", "STOPPED", "PLAYING",
                                                  "PAUSING",  "PAUSED",  "RESUMING"};
  return names[static_cast<std::size_t>(state)];
}

json program(const Bench & bench)
{
  const ProgramRunner & runner = bench.pendant.runner();
  return {{"state", name(bench.state.runtime_state)},
          {"name", runner.name()},
          {"loaded", bench.pendant.loaded_program()},
          {"threads", runner.machine() != nullptr ? runner.machine()->thread_count() : 0}};
}

json clients(const Bench & bench)
{
  json result;
  for (const auto & [link, listener] : bench.links) {
    result[link] = listener->clients();
  }
  result["rtde_control"] = bench.rtde.clients(rtde::ClientRole::control);
  result["rtde_receive"] = bench.rtde.clients(rtde::ClientRole::receive);
  result["rtde_io"] = bench.rtde.clients(rtde::ClientRole::io);
  result["rtde_dropped_packages"] = bench.rtde.dropped_packages();
  return result;
}

json io(const Io & io)
{
  return {{"digital_inputs", io.digital_inputs},   {"digital_outputs", io.digital_outputs},
          {"analog_inputs", io.analog_inputs},     {"analog_outputs", io.analog_outputs},
          {"analog_io_types", io.analog_io_types}, {"tool_analog_inputs", io.tool_analog_inputs}};
}

json registers(const Registers & registers)
{
  return {{"integers", registers.integers}, {"doubles", registers.doubles}};
}

json gripper(const Bench & bench)
{
  const SoftGripper * gripper = bench.world.gripper();
  if (gripper == nullptr) {
    return nullptr;
  }
  return {{"width", gripper->width()}, {"target", gripper->target()}, {"busy", gripper->busy()}};
}

json state(Bench & bench, Fields & fields)
{
  fields.finish();
  return {{"state", to_json(bench)}};
}

json get_registers(Bench & bench, Fields & fields)
{
  fields.finish();
  return {{"inputs", registers(bench.state.inputs)}, {"outputs", registers(bench.state.outputs)}};
}

json log(Bench & bench, Fields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  fields.finish();
  json entries = json::array();
  for (const LogEntry & entry : bench.log.entries()) {
    if (entry.number > after) {
      entries.push_back({{"number", entry.number},
                         {"timestamp", entry.timestamp},
                         {"level", ur_simulator::name(entry.level)},
                         {"source", entry.source},
                         {"text", entry.text}});
    }
  }
  return {{"entries", std::move(entries)}};
}

json trace(Bench & bench, Fields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  fields.finish();
  json cycles = json::array();
  bench.trace.for_each_cycle([&](const CycleTrace::Cycle & cycle) {
    if (cycle.number > after) {
      cycles.push_back({cycle.number, cycle.published, cycle.speed});
    }
  });
  json commands = json::array();
  json repeats = json::array();
  const auto add_to = [after](json & list) {
    return [&list, after](const CycleTrace::Command & command) {
      if (command.cycle >= after) {
        list.push_back({command.cycle, command.arrived, command.code});
      }
    };
  };
  bench.trace.for_each_command(add_to(commands));
  bench.trace.for_each_repeat(add_to(repeats));
  return {{"cycles", std::move(cycles)}, {"commands", std::move(commands)}, {"repeats", std::move(repeats)}};
}

constexpr std::array inquiry_command_table{
    Command{"state", "", "All of the state after the last cycle, in SI units.", state},
    Command{"registers", "", "The general purpose registers.", get_registers},
    Command{"log", "after (0)",
            "What the robot's log shows: the last 1000 entries, those numbered above 'after'.", log},
    Command{"trace", "after (0)",
            "By the host's clock, ns: the last 4096 cycles after 'after' as [cycle, sending began, fastest "
            "target joint rad/s], the last 256 commands in input integer register 0 as [cycle, arrived, "
            "code], and "
            "apart from them the last 1024 that repeat the one before.",
            trace},
};

}  // namespace

json to_json(const Bench & bench)
{
  const ControllerState & s = bench.state;
  const auto & popup = bench.pendant.runner().popup();
  const auto & safety_popup = bench.pendant.safety_popup();
  return {{"cycle", s.cycle},
          {"timestamp", s.timestamp},
          {"missed_cycles", bench.missed_cycles},
          {"model", bench.pendant.model().name},
          {"polyscope", bench.pendant.options().version.text()},
          {"robot_mode", to_string(s.robot_mode)},
          {"safety_mode", to_string(s.safety_mode)},
          {"robot_status_bits", s.robot_status_bits},
          {"safety_status_bits", s.safety_status_bits},
          {"remote_control", bench.pendant.remote_control()},
          {"program", program(bench)},
          {"popup", popup ? json(popup->message) : json(nullptr)},
          {"safety_popup", safety_popup ? json(*safety_popup) : json(nullptr)},
          {"target", joints(s.target)},
          {"actual", joints(s.actual)},
          {"target_tcp_pose", array(s.target_tcp_pose)},
          {"target_tcp_speed", array(s.target_tcp_speed)},
          {"actual_tcp_pose", array(s.actual_tcp_pose)},
          {"actual_tcp_speed", array(s.actual_tcp_speed)},
          {"actual_tcp_force", array(s.actual_tcp_force)},
          {"contact_wrench", array(s.contact_wrench)},
          {"tcp_offset", array(s.tcp_offset)},
          {"payload", {{"mass", s.payload.mass}, {"center_of_gravity", array(s.payload.center_of_gravity)}}},
          {"speed_slider", s.speed_slider},
          {"speed_scaling", s.speed_scaling},
          {"at_rest", bench.arm.at_rest()},
          {"steady", s.steady},
          {"freedrive", s.freedrive},
          {"force_mode", bench.arm.in_force_mode()},
          {"external_sensor", s.external_sensor.enabled},
          {"gripper", gripper(bench)},
          {"io", io(s.io)},
          {"clients", clients(bench)},
          {"actual_execution_time", s.actual_execution_time}};
}

std::span<const Command> inquiry_commands()
{
  return inquiry_command_table;
}

}  // namespace ur_simulator::control_port
