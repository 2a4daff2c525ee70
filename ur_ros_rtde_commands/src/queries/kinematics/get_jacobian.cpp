#include <ur_ros_rtde_msgs/action/get_jacobian.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetJacobian : public QueryCommand<ur_ros_rtde_msgs::action::GetJacobian> {
  void check(const Goal & goal, Check & check) const override
  {
    check_optional_joints(check, "joint_positions", goal.joint_positions)
        .that(goal.joint_velocities.empty(),
              "joint_velocities is used by get_jacobian_time_derivative only: leave it empty");
    check_optional_tcp(check, goal.use_tcp, goal.tcp).polyscope(23).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> q = or_current(goal.joint_positions, run.state().actual_q);
    run.result().matrix = query(run, [&](auto & control) {
      return to_row_major(control.getJacobian(q, tcp_or_active(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJacobian, "get_jacobian")

}  // namespace ur_ros_rtde
