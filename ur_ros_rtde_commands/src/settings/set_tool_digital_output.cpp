#include <ur_ros_rtde_msgs/action/set_digital_output.hpp>

#include "settings/await.hpp"

namespace ur_ros_rtde {

class SetToolDigitalOutput : public Command<ur_ros_rtde_msgs::action::SetDigitalOutput> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override { check.in_range("pin", goal.pin, 0, 1); }

  Outcome run(const Goal & goal, Run & run) override
  {
    return switch_output(run, goal.pin + 16U, goal.state,
                         [&](auto & io) { return io.setToolDigitalOut(goal.pin, goal.state); });
  }
};

UR_ROS_RTDE_EXPORT(SetToolDigitalOutput, "set_tool_digital_output")

}  // namespace ur_ros_rtde
