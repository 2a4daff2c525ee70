#include <ur_ros_rtde_msgs/action/servo_l.hpp>

#include "motion/servo/servo.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

class ServoL : public Command<ur_ros_rtde_msgs::action::ServoL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose);
    check_tcp_target(check_servo(check, goal, "m/s^2"), goal);
    if (const auto start = check.start(); start && goal.time > 0.0) {
      check_tcp_speed(check, start->actual_tcp_pose, tcp_target(goal, *start), goal.time);
    }
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_tcp_pose;
    const auto end = tcp_target(goal, run.state());
    const double time = goal.time > 0.0 ? goal.time : default_tcp_duration(start, end);
    const auto send = [&](const ServoStep & step) {
      const auto target = interpolate_pose(start, end, step.fraction);
      run.control()->servoL(target, 0.0, 0.0, step.cycle, goal.lookahead_time, goal.gain);
    };
    const auto check_again = [&](Check & check) { check_tcp_speed(check, start, end, time); };
    return servo(run, {time, goal.deceleration, check_again, true}, send,
                 [&] { return run.until_at_rest_at_pose(end); });
  }
};

UR_ROS_RTDE_EXPORT(ServoL, "servo_l")

}  // namespace ur_ros_rtde
