#include <ur_ros_rtde_msgs/action/move_l.hpp>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

class MoveL : public Command<ur_ros_rtde_msgs::action::MoveL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose)
        .above_zero("speed", goal.speed, 3.0, "m/s")
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2");
    check_tcp_target(check, goal);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = tcp_target(goal, run.state());
    run.control()->moveL(target, goal.speed, goal.acceleration, true);
    return run.until_pose_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveL, "move_l")

}  // namespace ur_ros_rtde
