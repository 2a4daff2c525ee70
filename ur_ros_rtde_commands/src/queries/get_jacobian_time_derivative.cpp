#include <ur_ros_rtde_msgs/action/get_jacobian.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class GetJacobianTimeDerivative : public Question<ur_ros_rtde_msgs::action::GetJacobian> {
  void check(const Goal & goal, Check & check) const override
  {
    joints_or_none(check, "joint_positions", goal.joint_positions);
    velocities_or_none(check, "joint_velocities", goal.joint_velocities);
    tcp_if(check, goal.use_tcp, goal.tcp).polyscope(23).answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Sample now = run.state();
    const std::vector<double> q = or_present(goal.joint_positions, now.actual_q);
    const std::vector<double> qd = or_present(goal.joint_velocities, now.actual_qd);
    run.result().matrix = answer(run, [&](auto & control) {
      return by_rows(control.getJacobianTimeDerivative(q, qd, tcp_of(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJacobianTimeDerivative, "get_jacobian_time_derivative")

}  // namespace ur_ros_rtde
