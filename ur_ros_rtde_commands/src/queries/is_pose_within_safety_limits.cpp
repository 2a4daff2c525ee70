#include <ur_ros_rtde_msgs/action/check_pose.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class IsPoseWithinSafetyLimits : public Question<ur_ros_rtde_msgs::action::CheckPose> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .that(goal.near.empty(), "near is of get_inverse_kinematics_has_solution only")
        .answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value =
        answer(run, [&](auto & control) { return control.isPoseWithinSafetyLimits(to_ur(goal.pose)); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsPoseWithinSafetyLimits, "is_pose_within_safety_limits")

}  // namespace ur_ros_rtde
