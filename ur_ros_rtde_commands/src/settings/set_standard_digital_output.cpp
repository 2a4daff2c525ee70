#include <ur_ros_rtde_msgs/action/set_digital_output.hpp>

#include "settings/await.hpp"

namespace ur_ros_rtde {

class SetStandardDigitalOutput : public Command<ur_ros_rtde_msgs::action::SetDigitalOutput> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override { check.in_range("pin", goal.pin, 0, 7); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return switch_output(run, goal.pin, goal.state,
                         [&](auto & io) { return io.setStandardDigitalOut(goal.pin, goal.state); });
  }
};

UR_ROS_RTDE_EXPORT(SetStandardDigitalOutput, "set_standard_digital_output")

}  // namespace ur_ros_rtde
