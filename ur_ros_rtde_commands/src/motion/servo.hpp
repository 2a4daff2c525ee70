#pragma once

#include <functional>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// What servo_j and servo_l have in common.
template <typename Goal>
Check & check_servo(const Goal & goal, Check & check)
{
  if (goal.time != 0.0) {
    check.in_range("time", goal.time, 0.01, 600.0, "s");
  }
  return check.in_range("lookahead_time", goal.lookahead_time, 0.03, 0.2, "s")
      .in_range("gain", goal.gain, 100.0, 2000.0)
      .in_range("deceleration", goal.deceleration, 0.1, 40.0, "rad/s^2");
}

/// The control script ends servo control along the TCP's line, hence the linear one.
template <typename Goal>
StopOptions servo_stop_options(const Goal & goal)
{
  return {.joint_deceleration = goal.deceleration, .linear_deceleration = goal.deceleration};
}

/// How far along its way a motion is after the share `u` of its time, both 0 to 1: from rest to rest without
/// a jump in the acceleration (the polynomial of minimum jerk, Flash and Hogan 1985).
double smooth_step(double u);
/// Its highest speed, as a multiple of the mean one.
constexpr double smooth_step_peak = 15.0 / 8.0;

/// s, that a goal without a time takes: as long as the joints, or the TCP, need with the default speeds and
/// accelerations (default_speeds.hpp).
double slow_joint_time(const Vector6 & from, const std::vector<double> & to);
double slow_tcp_time(const Vector6 & from, const std::vector<double> & to);

/// A servo motion of `duration` s: calls `send` once each control cycle with the share of the way
/// (smooth_step) and the length of the cycle (s), paced by the controller's packages; then waits for
/// `arrival`, and ends servo control. A host that comes late goes on from where it was: the arm is slower
/// then, never faster.
[[nodiscard]] Outcome servo(Run & run, double duration,
                            const std::function<void(double share, double cycle)> & send,
                            const std::function<Outcome()> & arrival, double deceleration);

/// Ends servo control after an arrival; a failed one is stopped by the base class.
[[nodiscard]] Outcome end_servo(Run & run, const Outcome & arrival, double deceleration);

/// At the share `s` of the way: joint positions; a pose of UR on the straight line, turning about one axis.
std::vector<double> joints_between(const Vector6 & from, const std::vector<double> & to, double s);
std::vector<double> pose_between(const Vector6 & from, const std::vector<double> & to, double s);

/// The TCP does not go faster than 3 m/s and 3.14 rad/s when it follows smooth_step from one pose of UR to
/// another in `time` s.
void check_tcp_speed(Check & check, const Vector6 & from, const std::vector<double> & to, double time);

}  // namespace ur_ros_rtde
