#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "motion/servo/servo_profile.hpp"
#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

template <typename Goal>
Check & check_servo_deceleration(Check & check, const Goal & goal, std::string_view unit)
{
  return check.in_range("deceleration", goal.deceleration, min_deceleration, max_servo_deceleration, unit);
}

/// Checks the fields that the goals of servo_j and servo_l have in common.
template <typename Goal>
Check & check_servo(Check & check, const Goal & goal, std::string_view unit_of_deceleration)
{
  if (goal.time != 0.0) {
    check.in_range("time", goal.time, 0.01, 600.0, "s");
  }
  check.in_range("lookahead_time", goal.lookahead_time, 0.03, 0.2, "s")
      .in_range("gain", goal.gain, 100.0, 2000.0);
  return check_servo_deceleration(check, goal, unit_of_deceleration);
}

/// The setpoints of joints stop in joint space, those of poses along the path of the TCP.
template <typename Goal>
StopOptions servo_stop_options(const Goal & goal)
{
  return {.joint_deceleration = goal.deceleration, .linear_deceleration = goal.deceleration};
}

/// A setpoint of a servo motion.
struct ServoStep {
  double fraction;  ///< traveled (smooth_step), 0 to 1
  double cycle;     ///< s, cycle time of the controller
  double time;      ///< cycles of the controller; lets the control program bridge late setpoints of servoJ
};

struct ServoMotion {
  double duration;      ///< s
  double deceleration;  ///< rad/s^2 or m/s^2, at its end
  /// Repeated where the motion begins: Run::check_again().
  std::function<void(Check &)> check;
  /// Its setpoints are poses: see check_joint_velocities().
  bool has_poses = false;
};

/// Executes a servo motion: calls `send` for each package of the controller, at the end twice
/// with the same fraction, then calls `wait_for_arrival`, and ends servo control. If the host is late, the
/// motion continues where it was: the arm becomes slower, never faster. Follows the speed slider.
[[nodiscard]] Outcome servo(Run & run, const ServoMotion & motion,
                            const std::function<void(const ServoStep &)> & send,
                            const std::function<Outcome()> & wait_for_arrival);

/// Ends servo control after a successful arrival. After a failure, the base class stops the arm.
[[nodiscard]] Outcome finish_servo(Run & run, const Outcome & arrival, double deceleration);

/// Checks that the TCP does not exceed 3 m/s and 3.14 rad/s if it follows smooth_step from one UR pose to
/// another in `time` s.
void check_tcp_speed(Check & check, const Vector6 & from, const std::vector<double> & to, double time);

}  // namespace ur_ros_rtde
