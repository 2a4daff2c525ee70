#include <ur_ros_rtde_msgs/action/check_pose.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetInverseKinematicsHasSolution : public QueryCommand<ur_ros_rtde_msgs::action::CheckPose> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose);
    check_optional_joints(check, "near", goal.near).polyscope(10, 15).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> near = or_current(goal.near, run.state().actual_q);
    run.result().value = query(
        run, [&](auto & control) { return control.getInverseKinematicsHasSolution(to_ur(goal.pose), near); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetInverseKinematicsHasSolution, "get_inverse_kinematics_has_solution")

}  // namespace ur_ros_rtde
