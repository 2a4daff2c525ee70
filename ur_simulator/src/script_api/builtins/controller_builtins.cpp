#include "script_api/robot_context.hpp"

namespace ur_simulator::script_api {

namespace {

std::optional<Watchdog::Action> parse_action(std::string name)
{
  for (char & c : name) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (name == "ignore") {
    return Watchdog::Action::ignore;
  }
  if (name == "pause") {
    return Watchdog::Action::pause;
  }
  return name == "stop" ? std::optional(Watchdog::Action::stop) : std::nullopt;
}

Outcome set_watchdog(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string variable = reader.string(0, "variable_name");
  const double frequency = reader.number(1, "min_frequency");
  const std::string name = reader.string(2, "action");
  const auto action = parse_action(name);
  reader.require(frequency >= 0.0, fmt::format("min_frequency must not be negative, is {}", frequency));
  reader.require(action.has_value(),
                 fmt::format("action must be \"ignore\", \"pause\" or \"stop\", is \"{}\"", name));
  if (!reader) {
    return reader.failure();
  }
  robot.access.watchdog.set(variable, frequency, *action, robot.state().timestamp);
  return Value();
}

Outcome get_rtde_value(RobotContext & robot, Arguments arguments)
{
  ArgumentReader reader(arguments);
  const std::string key = reader.string(0, "key");
  if (!reader) {
    return reader.failure();
  }
  auto value = robot.access.rtde_value ? robot.access.rtde_value(key) : std::nullopt;
  if (!value) {
    return Failure{fmt::format("there is no RTDE output '{}' in this version", key)};
  }
  return std::move(*value);
}

/// Takes effect after this cycle; the call returns in the next one. A secondary program may not wait.
Outcome power_down(const RobotContext & robot, const CallContext & context)
{
  if (robot.access.requests.power_down) {
    robot.access.requests.power_down();
  }
  return context.secondary ? Outcome(Value()) : Outcome(NextCycle{});
}

/// Returns at once: the safety system pauses the program where it next uses physical time. A program that
/// ends before has ended.
Outcome protective_stop(const RobotContext & robot)
{
  if (robot.access.requests.protective_stop) {
    robot.access.requests.protective_stop(error_codes::requested_protective_stop,
                                          "the program called protective_stop()");
  }
  return Value();
}

}  // namespace

void add_controller_builtins(Library & library, const RobotContextPtr & robot)
{
  library.add({"rtde_set_watchdog",
               {"variable_name", "min_frequency", {"action", Value("pause")}},
               2,
               [robot](CallContext &, Arguments arguments) { return set_watchdog(*robot, arguments); }});
  add_robot_builtin(library, robot, "get_rtde_value", {"key"}, 1, get_rtde_value, 50);
  library.add({"powerdown", {}, 0, [robot](CallContext & context, Arguments) {
                 return power_down(*robot, context);
               }});
  library.add(
      {"protective_stop", {}, 0, [robot](CallContext &, Arguments) { return protective_stop(*robot); }});
}

}  // namespace ur_simulator::script_api
