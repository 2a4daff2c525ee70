#include <ur_ros_rtde_msgs/action/speed_l.hpp>

#include "motion/velocity/velocity.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SpeedL : public Command<ur_ros_rtde_msgs::action::SpeedL> {
  void check(const Goal & goal, Check & check) const override
  {
    check_velocity_motion(check.twist("twist", goal.twist), goal, linear_speed_limits);
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    return {.linear_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedL(to_ur(goal.twist), goal.acceleration, 0.0);
    return wait_for_end(run, goal.time);
  }
};

UR_ROS_RTDE_EXPORT(SpeedL, "speed_l")

}  // namespace ur_ros_rtde
