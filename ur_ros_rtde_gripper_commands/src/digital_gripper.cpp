#include <fmt/format.h>

#include <ur_ros_rtde/command.hpp>
#include <ur_ros_rtde/digital_output.hpp>
#include <ur_ros_rtde_gripper_commands/action/digital_gripper.hpp>

namespace ur_ros_rtde_gripper_commands {
namespace {

using ur_ros_rtde::ErrorCode;
using ur_ros_rtde::Outcome;

constexpr int last_pin = static_cast<int>(ur_ros_rtde::digital_output_count) - 1;

/// Sets an output of the goal; -1 is none.
Outcome set_output(ur_ros_rtde::Run & run, int output, bool state)
{
  return output < 0 ? Outcome::success()
                    : ur_ros_rtde::set_digital_output(run, static_cast<unsigned>(output), state);
}

/// Reserve for a controller whose clock is slower than that of this host.
std::chrono::nanoseconds host_limit(double time)
{
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(2.0 * time + 5.0));
}

}  // namespace

class DigitalGripper : public ur_ros_rtde::Command<action::DigitalGripper> {
  ur_ros_rtde::CommandTraits traits() const override { return {.resource = ur_ros_rtde::Resource::io}; }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override
  {
    check.in_range("close_output", goal.close_output, -1, last_pin)
        .in_range("open_output", goal.open_output, -1, last_pin)
        .in_range("sensor_input", goal.sensor_input, -1, last_pin)
        .above_zero("time", goal.time, 60.0, "s")
        .that(goal.close_output != goal.open_output,
              fmt::format(
                  "close_output and open_output are both {}: set different outputs, or -1 for one of them",
                  goal.close_output));
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    // The opposite valve first, so that never both are on.
    const int on = goal.close ? goal.close_output : goal.open_output;
    const int off = goal.close ? goal.open_output : goal.close_output;
    if (Outcome outcome = set_output(run, off, false); !outcome) {
      return outcome;
    }
    if (Outcome outcome = set_output(run, on, true); !outcome) {
      return outcome;
    }
    return wait_for_end(goal, run);
  }

  static Outcome wait_for_end(const Goal & goal, Run & run)
  {
    const double begin = run.state().controller_time;
    const auto elapsed = [&] { return run.state().controller_time - begin; };
    const auto sensor_reached = [&] {
      return goal.sensor_input >= 0 &&
             (((run.state().digital_inputs >> static_cast<unsigned>(goal.sensor_input)) & 1U) != 0) ==
                 goal.sensor_state;
    };
    const auto reason =
        run.until([&] { return sensor_reached() || elapsed() >= goal.time; }, host_limit(goal.time));
    run.result().duration = elapsed();
    run.feedback().sensor_reached = sensor_reached();
    run.publish();
    if (reason) {
      return *reason;
    }
    const int on = goal.close ? goal.close_output : goal.open_output;
    if (on >= 0 && ((run.state().digital_outputs >> static_cast<unsigned>(on)) & 1U) == 0) {
      return Outcome::failure(ErrorCode::not_reached,
                              fmt::format("output {} was switched off while the fingers moved", on));
    }
    if (goal.sensor_input < 0 || run.feedback().sensor_reached) {
      return Outcome::success();
    }
    return Outcome::failure(
        ErrorCode::not_reached,
        fmt::format("input {} is still {} after {:g} s: check the supply voltage (set_tool_voltage), the "
                    "compressed air, the sensor, and whether there is a part to grip",
                    goal.sensor_input, goal.sensor_state ? "off" : "on", goal.time));
  }
};

UR_ROS_RTDE_EXPORT(DigitalGripper, "digital_gripper")

}  // namespace ur_ros_rtde_gripper_commands
