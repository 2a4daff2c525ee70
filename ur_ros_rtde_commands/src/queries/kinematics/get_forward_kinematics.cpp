#include <ur_ros_rtde_msgs/action/get_forward_kinematics.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetForwardKinematics : public QueryCommand<ur_ros_rtde_msgs::action::GetForwardKinematics> {
  void check(const Goal & goal, Check & check) const override
  {
    check_optional_joints(check, "joint_positions", goal.joint_positions);
    check_optional_tcp(check, goal.use_tcp, goal.tcp).answers_queries();
    if (!goal.use_tcp) {
      check.polyscope(0, 6);  // tells the active TCP
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> q = or_current(goal.joint_positions, run.state().actual_q);
    run.result().pose = query(run, [&](auto & control) {
      return to_pose(control.getForwardKinematics(q, tcp_or_active(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetForwardKinematics, "get_forward_kinematics")

}  // namespace ur_ros_rtde
