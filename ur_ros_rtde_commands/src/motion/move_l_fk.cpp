#include <ur_ros_rtde_msgs/action/move_lfk.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MoveLFK : public Command<ur_ros_rtde_msgs::action::MoveLFK> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions)
        .above_zero("speed", goal.speed, 3.0, "m/s")
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->moveL_FK(goal.joint_positions, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(goal.joint_positions);
  }
};

UR_ROS_RTDE_EXPORT(MoveLFK, "move_l_fk")

}  // namespace ur_ros_rtde
