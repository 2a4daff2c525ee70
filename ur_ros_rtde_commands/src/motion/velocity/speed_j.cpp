#include <ur_ros_rtde_msgs/action/speed_j.hpp>

#include "motion/velocity/velocity.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SpeedJ : public Command<ur_ros_rtde_msgs::action::SpeedJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joint_velocities("joint_velocities", goal.joint_velocities)
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2")
        .in_range("time", goal.time, 0.01, 3600.0, "s")
        .in_range("deceleration", goal.deceleration, 0.1, 40.0, "rad/s^2");
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    return {.joint_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedJ(goal.joint_velocities, goal.acceleration, 0.0);
    return finish_velocity_motion(run, goal.time, goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(SpeedJ, "speed_j")

}  // namespace ur_ros_rtde
