#include <array>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

json registers_to_json(const Registers & registers)
{
  return {{"integers", registers.integers}, {"doubles", registers.doubles}};
}

json state(ControlPortContext & context, RequestFields & fields)
{
  fields.reject_unknown();
  return {{"state", state_to_json(context)}};
}

json registers(ControlPortContext & context, RequestFields & fields)
{
  fields.reject_unknown();
  return {{"inputs", registers_to_json(context.state.inputs)},
          {"outputs", registers_to_json(context.state.outputs)}};
}

json log(ControlPortContext & context, RequestFields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  fields.reject_unknown();
  json entries = json::array();
  for (const LogEntry & entry : context.log.entries()) {
    if (entry.number > after) {
      entries.push_back({{"number", entry.number},
                         {"timestamp", entry.timestamp},
                         {"level", to_string(entry.level)},
                         {"source", entry.source},
                         {"text", entry.text}});
    }
  }
  return {{"entries", std::move(entries)}};
}

json trace(ControlPortContext & context, RequestFields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  fields.reject_unknown();
  json cycles = json::array();
  context.trace.for_each_cycle([&](const CycleTrace::Cycle & cycle) {
    if (cycle.number > after) {
      cycles.push_back({cycle.number, cycle.published, cycle.speed});
    }
  });
  json commands = json::array();
  json repeats = json::array();
  const auto append_to = [after](json & list) {
    return [&list, after](const CycleTrace::Command & command) {
      if (command.cycle >= after) {
        list.push_back({command.cycle, command.arrived, command.code});
      }
    };
  };
  context.trace.for_each_command(append_to(commands));
  context.trace.for_each_repeat(append_to(repeats));
  return {{"cycles", std::move(cycles)}, {"commands", std::move(commands)}, {"repeats", std::move(repeats)}};
}

constexpr std::array query_command_table{
    Command{"state", "", "Returns the state after the last control cycle, in SI units.", state},
    Command{"registers", "", "Returns the general purpose registers.", registers},
    Command{"log", "after (0)", "Returns those of the last 1000 log entries whose number is above 'after'.",
            log},
    Command{"trace", "after (0)",
            "Returns times of the host's clock, ns: the last 4096 cycles after 'after' as [cycle, start of "
            "sending, largest target joint speed rad/s], the last 256 commands in input integer register 0 "
            "as [cycle, arrival, code], and separately the last 1024 commands with the same code as the "
            "previous one.",
            trace},
};

}  // namespace

std::span<const Command> query_commands()
{
  return query_command_table;
}

}  // namespace ur_simulator::control_port
