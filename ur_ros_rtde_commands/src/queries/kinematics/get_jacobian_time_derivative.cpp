#include <ur_ros_rtde_msgs/action/get_jacobian.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetJacobianTimeDerivative : public QueryCommand<ur_ros_rtde_msgs::action::GetJacobian> {
  void check(const Goal & goal, Check & check) const override
  {
    check_optional_joints(check, "joint_positions", goal.joint_positions);
    check_optional_velocities(check, "joint_velocities", goal.joint_velocities);
    check_optional_tcp(check, goal.use_tcp, goal.tcp).polyscope(23).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Sample now = run.state();
    const std::vector<double> q = or_current(goal.joint_positions, now.actual_q);
    const std::vector<double> qd = or_current(goal.joint_velocities, now.actual_qd);
    run.result().matrix = query(run, [&](auto & control) {
      return to_row_major(
          control.getJacobianTimeDerivative(q, qd, tcp_or_active(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJacobianTimeDerivative, "get_jacobian_time_derivative")

}  // namespace ur_ros_rtde
