#include <ur_ros_rtde_msgs/action/check_pose.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class IsPoseWithinSafetyLimits : public QueryCommand<ur_ros_rtde_msgs::action::CheckPose> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .that(goal.near.empty(), "near is used by get_inverse_kinematics_has_solution only: leave it empty")
        .answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value =
        query(run, [&](auto & control) { return control.isPoseWithinSafetyLimits(to_ur(goal.pose)); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsPoseWithinSafetyLimits, "is_pose_within_safety_limits")

}  // namespace ur_ros_rtde
