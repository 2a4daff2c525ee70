#include <ur_ros_rtde_msgs/action/set_force_mode_parameter.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class ForceModeSetDamping : public Command<ur_ros_rtde_msgs::action::SetForceModeParameter> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("value", goal.value, 0.0, 1.0).polyscope(0, 5).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    check_result(run.control()->forceModeSetDamping(goal.value), "set the damping of force mode");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(ForceModeSetDamping, "force_mode_set_damping")

}  // namespace ur_ros_rtde
