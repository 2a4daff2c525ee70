#include <fmt/format.h>

#include <array>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

json registers_to_json(const Registers & registers)
{
  return {{"integers", registers.integers}, {"doubles", registers.floats}};
}

Action state(RequestFields &)
{
  return [](ControlPortContext & context) -> json { return {{"state", state_to_json(context)}}; };
}

Action registers(RequestFields &)
{
  return [](ControlPortContext & context) -> json {
    return {{"inputs", registers_to_json(context.state.inputs)},
            {"outputs", registers_to_json(context.state.outputs)}};
  };
}

Action log(RequestFields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  return [=](ControlPortContext & context) -> json {
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
  };
}

template <typename Entries, typename ToJson>
json entries_from(const Entries & entries, std::uint64_t first_cycle, ToJson && to_json)
{
  json list = json::array();
  entries.for_each([&](const auto & entry) {
    if (entry.cycle >= first_cycle) {
      list.push_back(to_json(entry));
    }
  });
  return list;
}

json cycle_to_json(const CycleTrace::Cycle & cycle)
{
  return {cycle.cycle, cycle.published, cycle.joint_speed, cycle.tcp_speed};
}

json command_to_json(const CycleTrace::Command & command)
{
  return {command.cycle, command.arrived, command.code};
}

json repeat_to_json(const CycleTrace::Repeat & repeat)
{
  return {repeat.cycle, repeat.arrived, repeat.code, repeat.is_held};
}

Action trace(RequestFields & fields)
{
  const auto after = static_cast<std::uint64_t>(fields.integer("after", 0, INT64_MAX, 0));
  return [=](ControlPortContext & context) -> json {
    const CycleTrace & trace = context.trace;
    if (after > 0 && after <= trace.last_incomplete_cycle()) {
      throw RequestError(
          fmt::format("field 'after' is {}: the trace is complete only after cycle {}; request it "
                      "more often, or without 'after' for what is left",
                      after, trace.last_incomplete_cycle()),
          "after");
    }
    return {{"cycles", entries_from(trace.cycles(), after + 1, cycle_to_json)},
            {"commands", entries_from(trace.commands(), after, command_to_json)},
            {"repeats", entries_from(trace.repeats(), after, repeat_to_json)}};
  };
}

constexpr std::array query_command_table{
    Command{"state", "", "Returns the state after the last control cycle, in SI units.", state},
    Command{"registers", "", "Returns the general purpose registers.", registers},
    Command{"log", "after (0)", "Returns those of the last 1000 log entries whose number is above 'after'.",
            log},
    Command{
        "trace", "after (0)",
        "Returns times of the host's clock, ns: the cycles after 'after' (at most 16384) as [cycle, start "
        "of sending, largest target joint speed rad/s, target TCP speed m/s], the commands in input integer "
        "register 0 from "
        "cycle 'after' on (at most 256) as [cycle, arrival, code], and separately those with the same "
        "code as the previous one (at most 16384), followed by whether they hold its target. Fails if data "
        "after 'after' has been overwritten.",
        trace},
};

}  // namespace

std::span<const Command> query_commands()
{
  return query_command_table;
}

}  // namespace ur_simulator::control_port
