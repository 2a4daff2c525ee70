#include <ur_ros_rtde_msgs/action/speed_j.hpp>

#include "motion/velocity/velocity.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SpeedJ : public Command<ur_ros_rtde_msgs::action::SpeedJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check_velocity_motion(check.joint_velocities("joint_velocities", goal.joint_velocities), goal,
                          joint_speed_limits);
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    return {.joint_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedJ(goal.joint_velocities, goal.acceleration, 0.0);
    return wait_for_end(run, goal.time);
  }
};

UR_ROS_RTDE_EXPORT(SpeedJ, "speed_j")

}  // namespace ur_ros_rtde
