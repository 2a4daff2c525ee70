#include <ur_ros_rtde_msgs/action/move_j.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MoveJ : public Command<ur_ros_rtde_msgs::action::MoveJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions)
        .above_zero("speed", goal.speed, 3.14, "rad/s")
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->moveJ(goal.joint_positions, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(goal.joint_positions);
  }
};

UR_ROS_RTDE_EXPORT(MoveJ, "move_j")

}  // namespace ur_ros_rtde
