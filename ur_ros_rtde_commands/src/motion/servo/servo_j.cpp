#include <ur_ros_rtde_msgs/action/servo_j.hpp>

#include "motion/servo/servo.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

namespace {
void check_in_time(Check & check, const std::vector<double> & positions, double time)
{
  check.reachable_in("joint_positions", positions, time, smooth_step_peak);
}
}  // namespace

class ServoJ : public Command<ur_ros_rtde_msgs::action::ServoJ> {
  void check(const Goal & goal, Check & check) const override
  {
    check.joints("joint_positions", goal.joint_positions);
    if (check_servo(check, goal, "rad/s^2").ok() && goal.time > 0.0) {
      check_in_time(check, goal.joint_positions, goal.time);
    }
  }

  StopOptions stop_options(const Goal & goal) const override { return servo_stop_options(goal); }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_q;
    const double time = goal.time > 0.0 ? goal.time : default_joint_duration(start, goal.joint_positions);
    const auto check_again = [&](Check & check) { check_in_time(check, goal.joint_positions, time); };
    const auto send = [&](const ServoStep & step) {
      const auto target = interpolate_joints(start, goal.joint_positions, step.fraction);
      run.control()->servoJ(target, 0.0, 0.0, step.cycle, goal.lookahead_time, goal.gain, step.time);
    };
    const auto wait_for_arrival = [&] { return run.until_at_rest_at_joints(goal.joint_positions); };
    return servo(run, {time, goal.deceleration, check_again}, send, wait_for_arrival);
  }
};

UR_ROS_RTDE_EXPORT(ServoJ, "servo_j")

}  // namespace ur_ros_rtde
