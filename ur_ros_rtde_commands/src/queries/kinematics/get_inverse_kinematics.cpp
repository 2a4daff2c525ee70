#include <ur_ros_rtde_msgs/action/get_inverse_kinematics.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetInverseKinematics : public QueryCommand<ur_ros_rtde_msgs::action::GetInverseKinematics> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("max_position_error", goal.max_position_error, 0.1, "m")
        .above_zero("max_orientation_error", goal.max_orientation_error, 0.1, "rad");
    check_optional_joints(check, "near", goal.near).polyscope(10, 15).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> pose = to_ur(goal.pose);
    const std::vector<double> near = or_current(goal.near, run.state().actual_q);
    return query(run, [&](auto & control) {
      const double position = goal.max_position_error;
      const double orientation = goal.max_orientation_error;
      // A request for a solution that does not exist would end the control program.
      if (!control.getInverseKinematicsHasSolution(pose, near, position, orientation)) {
        return Outcome::failure(ErrorCode::unreachable, "pose is out of reach");
      }
      run.result().joint_positions =
          to_array6(control.getInverseKinematics(pose, near, position, orientation));
      return Outcome::success();
    });
  }
};

UR_ROS_RTDE_EXPORT(GetInverseKinematics, "get_inverse_kinematics")

}  // namespace ur_ros_rtde
