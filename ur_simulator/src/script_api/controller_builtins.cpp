#include "script_api/robot.hpp"

namespace ur_simulator::script_api {

namespace {

std::optional<Watchdog::Action> action_named(std::string name)
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

Outcome set_watchdog(Robot & robot, Arguments arguments)
{
  ArgumentReader in(arguments);
  const std::string variable = in.string(0, "variable_name");
  const double frequency = in.number(1, "min_frequency");
  const std::string name = in.string(2, "action");
  const auto action = action_named(name);
  in.require(frequency >= 0.0, fmt::format("min_frequency = {} is negative", frequency));
  in.require(action.has_value(),
             fmt::format("action \"{}\" is none of \"ignore\", \"pause\", \"stop\"", name));
  if (!in) {
    return in.failure();
  }
  robot.access.watchdog.set(variable, frequency, *action, robot.state().timestamp);
  return Value();
}

// The requests take effect after this cycle, so the call must not return within it.
Outcome request(const std::function<void()> & what)
{
  if (what) {
    what();
  }
  return NextCycle{};
}

}  // namespace

void add_controller_builtins(Library & library, const RobotPtr & robot)
{
  library.add({"rtde_set_watchdog",
               {"variable_name", "min_frequency", {"action", Value("pause")}},
               2,
               [robot](CallContext &, Arguments arguments) { return set_watchdog(*robot, arguments); }});
  library.add({"powerdown", {}, 0, [robot](CallContext &, Arguments) {
                 return request(robot->access.requests.power_down);
               }});
  library.add({"protective_stop", {}, 0, [robot](CallContext &, Arguments) {
                 return request(robot->access.requests.protective_stop);
               }});
}

}  // namespace ur_simulator::script_api
