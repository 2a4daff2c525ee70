#include <ur_ros_rtde_msgs/action/move_jik.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MoveJIK : public Command<ur_ros_rtde_msgs::action::MoveJIK> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("speed", goal.speed, 3.14, "rad/s")
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2")
        .reachable("pose", goal.pose);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->moveJ_IK(to_ur(goal.pose), goal.speed, goal.acceleration, true);
    return run.until_pose_reached(to_ur(goal.pose));
  }
};

UR_ROS_RTDE_EXPORT(MoveJIK, "move_j_ik")

}  // namespace ur_ros_rtde
