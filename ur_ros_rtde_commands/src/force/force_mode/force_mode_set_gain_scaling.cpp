#include <ur_ros_rtde_msgs/action/set_force_mode_parameter.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ForceModeSetGainScaling : public Command<ur_ros_rtde_msgs::action::SetForceModeParameter> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("value", goal.value, 0.0, 2.0).polyscope(0).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    check_result(run.control()->forceModeSetGainScaling(goal.value), "set the gain of force mode");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(ForceModeSetGainScaling, "force_mode_set_gain_scaling")

}  // namespace ur_ros_rtde
