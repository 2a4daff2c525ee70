#include <ur_ros_rtde_msgs/action/servo_c.hpp>

#include "motion/servo/servo.hpp"
#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

class ServoC : public Command<ur_ros_rtde_msgs::action::ServoC> {
  void check(const Goal & goal, Check & check) const override
  {
    check_speed(check.pose("pose", goal.pose), goal, linear_speed_limits)
        .in_range("blend_radius", goal.blend_radius, 0.0, 2.0, "m");
    check_tcp_target(check_servo_deceleration(check, goal, "m/s^2"), goal);
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = tcp_target(goal, run.state());
    run.control()->servoC(target, goal.speed, goal.acceleration, goal.blend_radius);
    return finish_servo(run, run.until_at_rest_at_pose(target), goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(ServoC, "servo_c")

}  // namespace ur_ros_rtde
