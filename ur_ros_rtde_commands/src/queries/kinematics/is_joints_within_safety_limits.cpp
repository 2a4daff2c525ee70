#include <ur_ros_rtde_msgs/action/check_joints.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class IsJointsWithinSafetyLimits : public QueryCommand<ur_ros_rtde_msgs::action::CheckJoints> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value =
        query(run, [&](auto & control) { return control.isJointsWithinSafetyLimits(goal.joint_positions); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(IsJointsWithinSafetyLimits, "is_joints_within_safety_limits")

}  // namespace ur_ros_rtde
