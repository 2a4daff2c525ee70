#include <ur_ros_rtde_msgs/action/get_forward_kinematics.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class GetForwardKinematics : public Question<ur_ros_rtde_msgs::action::GetForwardKinematics> {
  void check(const Goal & goal, Check & check) const override
  {
    joints_or_none(check, "joint_positions", goal.joint_positions);
    tcp_if(check, goal.use_tcp, goal.tcp).answers();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> q = or_present(goal.joint_positions, run.state().actual_q);
    run.result().pose = answer(run, [&](auto & control) {
      return to_pose(control.getForwardKinematics(q, tcp_of(control, goal.use_tcp, goal.tcp)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetForwardKinematics, "get_forward_kinematics")

}  // namespace ur_ros_rtde
