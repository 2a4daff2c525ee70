#include "motion/servo/servo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_linear_speed = 3.0;    // m/s
constexpr double max_angular_speed = 3.14;  // rad/s

constexpr double min_duration = 0.01;  // s
/// The peak acceleration of smooth_step for a distance of 1 in 1 s.
const double smooth_step_acceleration = 10.0 / std::sqrt(3.0);

/// The duration (s) of smooth_step over `distance` within the limits.
double default_duration(double distance, double speed, double acceleration)
{
  return std::max({min_duration, smooth_step_peak * distance / speed,
                   std::sqrt(smooth_step_acceleration * distance / acceleration)});
}

/// The pose `to` in the frame of the pose `from`.
Vector6 relative_pose(const Vector6 & from, const std::vector<double> & to)
{
  Vector6 target;
  std::copy_n(to.begin(), target.size(), target.begin());
  return pose_trans(pose_inverse(from), target);
}
}  // namespace

double smooth_step(double u)
{
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

double default_joint_duration(const Vector6 & from, const std::vector<double> & to)
{
  double longest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    longest = std::max(longest, std::abs(to[i] - from[i]));
  }
  return default_duration(longest, default_joint_speed, default_joint_acceleration);
}

double default_tcp_duration(const Vector6 & from, const std::vector<double> & to)
{
  const Vector6 offset = relative_pose(from, to);
  const double distance = std::hypot(offset[0], offset[1], offset[2]);
  const double angle = std::hypot(offset[3], offset[4], offset[5]);
  return std::max(default_duration(distance, default_linear_speed, default_linear_acceleration),
                  default_duration(angle, default_angular_speed, default_angular_acceleration));
}

Outcome servo(Run & run, double duration, const std::function<void(const ServoStep &)> & send,
              const std::function<Outcome()> & wait_for_arrival, double deceleration)
{
  const auto version = run.robot().version();
  const double cycle = 1.0 / (version ? version->frequency() : 500.0);
  Sample sample = run.state();
  double setpoint_time = sample.controller_time / cycle;
  bool at_end = false;
  for (double time = 0.0; !at_end;) {
    at_end = time >= duration;
    const double before = sample.controller_time;
    if (auto stop_reason = run.next(sample)) {
      return *stop_reason;
    }
    const double elapsed = std::clamp(sample.controller_time - before, 0.0, 2.0 * cycle);
    time += elapsed;
    setpoint_time += elapsed / cycle;
    run.progress(smooth_step(std::min(time / duration, 1.0)));
    send({run.progress(), cycle, setpoint_time});
  }
  return finish_servo(run, wait_for_arrival(), deceleration);
}

Outcome finish_servo(Run & run, const Outcome & arrival, double deceleration)
{
  if (arrival) {
    run.control()->servoStop(deceleration);
  }
  return arrival;
}

std::vector<double> interpolate_joints(const Vector6 & from, const std::vector<double> & to, double s)
{
  std::vector<double> joints(from.begin(), from.end());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] += s * (to[i] - from[i]);
  }
  return joints;
}

std::vector<double> interpolate_pose(const Vector6 & from, const std::vector<double> & to, double s)
{
  Vector6 offset = relative_pose(from, to);
  for (double & value : offset) {
    value *= s;
  }
  const Vector6 pose = pose_trans(from, offset);
  return {pose.begin(), pose.end()};
}

void check_tcp_speed(Check & check, const Vector6 & from, const std::vector<double> & to, double time)
{
  const Vector6 offset = relative_pose(from, to);
  const double linear = smooth_step_peak * std::hypot(offset[0], offset[1], offset[2]);
  const double angular = smooth_step_peak * std::hypot(offset[3], offset[4], offset[5]);
  const double min_time = std::max(linear / max_linear_speed, angular / max_angular_speed);
  check.that(
      time >= min_time,
      fmt::format("the TCP would need {:.3f} m/s and {:.3f} rad/s to reach pose in {:.3f} s, the limits "
                  "are {} m/s and {} rad/s: use a time of at least {:.3f} s",
                  linear / time, angular / time, time, max_linear_speed, max_angular_speed, min_time));
}

}  // namespace ur_ros_rtde
