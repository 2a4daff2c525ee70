#include <ur_ros_rtde_msgs/action/speed_l.hpp>

#include "motion/velocity/velocity.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SpeedL : public Command<ur_ros_rtde_msgs::action::SpeedL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.twist("twist", goal.twist)
        .above_zero("acceleration", goal.acceleration, 150.0, "m/s^2")
        .in_range("time", goal.time, 0.01, 3600.0, "s")
        .in_range("deceleration", goal.deceleration, 0.1, 150.0, "m/s^2");
  }

  StopOptions stop_options(const Goal & goal) const override
  {
    return {.linear_deceleration = goal.deceleration};
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.control()->speedL(to_ur(goal.twist), goal.acceleration, 0.0);
    return finish_velocity_motion(run, goal.time, goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(SpeedL, "speed_l")

}  // namespace ur_ros_rtde
