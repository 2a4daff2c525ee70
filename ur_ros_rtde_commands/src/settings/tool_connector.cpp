#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ur_ros_rtde_msgs/action/set_tool_analog_input_domain.hpp>
#include <ur_ros_rtde_msgs/action/set_tool_communication.hpp>
#include <ur_ros_rtde_msgs/action/set_tool_digital_output_mode.hpp>
#include <ur_ros_rtde_msgs/action/set_tool_output_mode.hpp>
#include <ur_ros_rtde_msgs/action/set_tool_voltage.hpp>

#include "settings/setting_helpers.hpp"
#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"

// Settings of the tool connector. RTDE has no inputs for them: a secondary program sets them, which runs
// beside the control program, also during a motion.

namespace ur_ros_rtde {
namespace {

namespace action = ur_ros_rtde_msgs::action;

Outcome run_statement(Run & run, const std::string & statement)
{
  ScriptOptions options;
  options.kind = ScriptKind::secondary;
  options.timeout = std::chrono::seconds(2);
  const ScriptReport report = run.run_script(statement, options);
  return report ? Outcome::success() : Outcome(report.error);
}

/// Waits until RTDE output `field` has the property.
Outcome wait_for_output(Run & run, const std::string & field, const std::function<bool(double)> & is_set)
{
  auto subscription = RtdeSubscription::open(run.robot().address(), {field}, 0.0);
  if (!subscription) {
    return subscription.error();
  }
  const auto end = RtdeSubscription::Clock::now() + setting_timeout;
  double value = 0.0;
  while (RtdeSubscription::Clock::now() < end) {
    if (auto reason = run.stop_reason()) {
      return *reason;
    }
    const auto received = subscription->next(std::span(&value, 1),
                                             RtdeSubscription::Clock::now() + std::chrono::milliseconds(50));
    if (!received) {
      return received.error();
    }
    if (*received && is_set(value)) {
      return Outcome::success();
    }
  }
  return Outcome::failure(
      ErrorCode::rejected_by_robot,
      fmt::format("the robot still reports {} = {}: check in the installation on the robot "
                  "whether a URCap controls the tool connector (Tool I/O)",
                  field, value));
}

Outcome set_and_wait(Run & run, const std::string & statement, const std::string & field, int expected)
{
  if (Outcome outcome = run_statement(run, statement); !outcome) {
    return outcome;
  }
  return wait_for_output(run, field, [expected](double value) { return value == expected; });
}

}  // namespace

template <typename A>
class ToolConnectorCommand : public Command<A> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }
};

class SetToolVoltage : public ToolConnectorCommand<action::SetToolVoltage> {
  void check(const Goal & goal, Check & check) const override
  {
    check.that(goal.voltage == 0 || goal.voltage == 12 || goal.voltage == 24,
               fmt::format("voltage is {} V, it must be 0, 12 or 24", goal.voltage));
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_and_wait(run, fmt::format("set_tool_voltage({})", goal.voltage), "tool_output_voltage",
                        goal.voltage);
  }
};

UR_ROS_RTDE_EXPORT(SetToolVoltage, "set_tool_voltage")

class SetToolOutputMode : public ToolConnectorCommand<action::SetToolOutputMode> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("mode", goal.mode, 0, 1).polyscope(0);
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_and_wait(run, fmt::format("set_tool_output_mode({})", goal.mode), "tool_output_mode",
                        goal.mode);
  }
};

UR_ROS_RTDE_EXPORT(SetToolOutputMode, "set_tool_output_mode")

class SetToolDigitalOutputMode : public ToolConnectorCommand<action::SetToolDigitalOutputMode> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("pin", goal.pin, 0, 1).in_range("mode", goal.mode, 1, 3).polyscope(0);
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    return set_and_wait(run, fmt::format("set_tool_digital_output_mode({}, {})", goal.pin, goal.mode),
                        fmt::format("tool_digital_output{}_mode", goal.pin), goal.mode);
  }
};

UR_ROS_RTDE_EXPORT(SetToolDigitalOutputMode, "set_tool_digital_output_mode")

class SetToolAnalogInputDomain : public ToolConnectorCommand<action::SetToolAnalogInputDomain> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("pin", goal.pin, 0, 1).in_range("domain", goal.domain, 0, 1);
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    const auto statement = fmt::format("set_tool_analog_input_domain({}, {})", goal.pin, goal.domain);
    if (Outcome outcome = run_statement(run, statement); !outcome) {
      return outcome;
    }
    return wait_for_output(run, "tool_analog_input_types", [&goal](double types) {
      return ((static_cast<unsigned>(types) >> goal.pin) & 1U) == goal.domain;
    });
  }
};

UR_ROS_RTDE_EXPORT(SetToolAnalogInputDomain, "set_tool_analog_input_domain")

class SetToolCommunication : public ToolConnectorCommand<action::SetToolCommunication> {
  void check(const Goal & goal, Check & check) const override
  {
    // Script manual, "set_tool_communication".
    constexpr std::array<std::uint32_t, 8> rates{9600,   19200,   38400,   57600,
                                                 115200, 1000000, 2000000, 5000000};
    check
        .that(std::ranges::find(rates, goal.baud_rate) != rates.end(),
              fmt::format("baud_rate is {}, it must be one of 9600, 19200, 38400, 57600, 115200, 1000000, "
                          "2000000 and 5000000",
                          goal.baud_rate))
        .in_range("parity", goal.parity, 0, 2)
        .in_range("stop_bits", goal.stop_bits, 1, 2)
        .in_range("rx_idle_chars", goal.rx_idle_chars, 1.0, 40.0, "characters")
        .in_range("tx_idle_chars", goal.tx_idle_chars, 0.0, 40.0, "characters")
        .polyscope(0);
  }
  Outcome run(const Goal & goal, Run & run) override
  {
    return run_statement(run, fmt::format("set_tool_communication({}, {}, {}, {}, {:.6f}, {:.6f})",
                                          goal.enabled ? "True" : "False", goal.baud_rate, goal.parity,
                                          goal.stop_bits, goal.rx_idle_chars, goal.tx_idle_chars));
  }
};

UR_ROS_RTDE_EXPORT(SetToolCommunication, "set_tool_communication")

}  // namespace ur_ros_rtde
