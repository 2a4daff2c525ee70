#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/set_digital_output.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SetDigitalOutput : public Command<ur_ros_rtde_msgs::action::SetDigitalOutput> {
  Resource resource() const override { return Resource::none; }

  void check(const Goal & goal, Check & check) const override { check.in_range("pin", goal.pin, 0, 17); }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (goal.pin < 8) {
      run.io()->setStandardDigitalOut(goal.pin, goal.state);
    } else if (goal.pin < 16) {
      run.io()->setConfigurableDigitalOut(static_cast<std::uint8_t>(goal.pin - 8), goal.state);
    } else {
      run.io()->setToolDigitalOut(static_cast<std::uint8_t>(goal.pin - 16), goal.state);
    }
    const auto is_set = [&] { return (((run.state().digital_outputs >> goal.pin) & 1U) != 0) == goal.state; };
    return run.expect(
        is_set, std::chrono::seconds(1),
        fmt::format("output {} stays {}: the installation on the robot may have given it another task",
                    goal.pin, goal.state ? "off" : "on"));
  }
};

UR_ROS_RTDE_EXPORT(SetDigitalOutput, "set_digital_output")

}  // namespace ur_ros_rtde
