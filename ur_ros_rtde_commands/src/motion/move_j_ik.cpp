#include <ur_ros_rtde_msgs/action/move_jik.hpp>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

class MoveJIK : public Command<ur_ros_rtde_msgs::action::MoveJIK> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("speed", goal.speed, 3.14, "rad/s")
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2");
    check_tcp_target(check, goal);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = tcp_target(goal, run.state());
    run.control()->moveJ_IK(target, goal.speed, goal.acceleration, true);
    return run.until_pose_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveJIK, "move_j_ik")

}  // namespace ur_ros_rtde
