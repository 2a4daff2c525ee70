#include <ur_ros_rtde_msgs/action/move_l.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MoveL : public Command<ur_ros_rtde_msgs::action::MoveL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("speed", goal.speed, 3.0, "m/s")
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .reachable("pose", goal.pose);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->moveL(to_ur(goal.pose), goal.speed, goal.acceleration, true);
    return run.until_pose_reached(to_ur(goal.pose));
  }
};

UR_ROS_RTDE_EXPORT(MoveL, "move_l")

}  // namespace ur_ros_rtde
