#include <ur_ros_rtde_msgs/action/set_digital_output.hpp>

#include "settings/await.hpp"

namespace ur_ros_rtde {

class SetDigitalOutput : public Command<ur_ros_rtde_msgs::action::SetDigitalOutput> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override { check.in_range("pin", goal.pin, 0, 17); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return switch_output(run, goal.pin, goal.state, [&](auto & io) {
      if (goal.pin < 8) {
        return io.setStandardDigitalOut(goal.pin, goal.state);
      }
      if (goal.pin < 16) {
        return io.setConfigurableDigitalOut(static_cast<std::uint8_t>(goal.pin - 8), goal.state);
      }
      return io.setToolDigitalOut(static_cast<std::uint8_t>(goal.pin - 16), goal.state);
    });
  }
};

UR_ROS_RTDE_EXPORT(SetDigitalOutput, "set_digital_output")

}  // namespace ur_ros_rtde
