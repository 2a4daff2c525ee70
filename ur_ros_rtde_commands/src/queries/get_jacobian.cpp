#include <ur_ros_rtde_msgs/action/get_jacobian.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class GetJacobian : public Question<ur_ros_rtde_msgs::action::GetJacobian> {
  void check(const Goal & goal, Check & check) const override
  {
    joints_or_none(check, "joint_positions", goal.joint_positions)
        .that(goal.joint_velocities.empty(), "joint_velocities is of get_jacobian_time_derivative only");
    tcp_if(check, goal.use_tcp, goal.tcp).polyscope(23).answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> q = or_present(goal.joint_positions, run.state().actual_q);
    run.result().matrix = answer(run, [&](auto & control) {
      return by_rows(control.getJacobian(q, tcp_of(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJacobian, "get_jacobian")

}  // namespace ur_ros_rtde
