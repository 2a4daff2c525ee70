#include <ur_ros_rtde_msgs/action/servo_l.hpp>

#include "motion/servo/servo.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/streaming.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

class ServoL : public Command<ur_ros_rtde_msgs::action::ServoL> {
  void check(const Goal & goal, Check & check) const override
  {
    check.pose("pose", goal.pose);
    check_tcp_target(check_servo(check, goal), goal);
    if (const auto start = check.start(); start && goal.time > 0.0) {
      check_tcp_speed(check, start->actual_tcp_pose, tcp_target(goal, *start), goal.time);
    }
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Sample sample = run.state();
    const Vector6 & start = sample.actual_tcp_pose;
    const auto end = tcp_target(goal, sample);
    const double time = goal.time > 0.0 ? goal.time : default_tcp_duration(start, end);
    Check again;  // a goal that was preempted, or force mode, has moved the arm in the meantime
    check_tcp_speed(again, start, end, time);
    if (!again.ok()) {
      return *again.error();
    }
    const ArmLimits limits = run.robot().limits();
    const auto send = [&](const ServoStep & step) {
      if (const Status safe = check_joint_velocities(run.state(), limits); !safe) {
        throw RobotError(safe.error());
      }
      const auto target = interpolate_pose(start, end, step.fraction);
      run.control()->servoL(target, 0.0, 0.0, step.cycle, goal.lookahead_time, goal.gain);
    };
    return servo(run, time, send, [&] { return run.until_at_rest_at_pose(end); }, goal.deceleration);
  }
};

UR_ROS_RTDE_EXPORT(ServoL, "servo_l")

}  // namespace ur_ros_rtde
