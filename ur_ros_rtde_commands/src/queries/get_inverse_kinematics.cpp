#include <ur_ros_rtde_msgs/action/get_inverse_kinematics.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class GetInverseKinematics : public Question<ur_ros_rtde_msgs::action::GetInverseKinematics> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("max_position_error", goal.max_position_error, 0.1, "m")
        .above_zero("max_orientation_error", goal.max_orientation_error, 0.1, "rad");
    joints_or_none(check, "near", goal.near).polyscope(10, 15).answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> pose = to_ur(goal.pose);
    const std::vector<double> near = or_present(goal.near, run.state().actual_q);
    return answer(run, [&](auto & control) {
      const double position = goal.max_position_error;
      const double orientation = goal.max_orientation_error;
      // Asking for a solution that there is not would end the control program.
      if (!control.getInverseKinematicsHasSolution(pose, near, position, orientation)) {
        return Outcome::failure(ErrorCode::unreachable,
                                "no joint positions lead to pose: it is out of reach");
      }
      run.result().joint_positions = six(control.getInverseKinematics(pose, near, position, orientation));
      return Outcome::success();
    });
  }
};

UR_ROS_RTDE_EXPORT(GetInverseKinematics, "get_inverse_kinematics")

}  // namespace ur_ros_rtde
