#include "servo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double highest_linear_speed = 3.0;    // m/s
constexpr double highest_angular_speed = 3.14;  // rad/s

constexpr double shortest_time = 0.01;  // s
/// The largest acceleration of smooth_step, for a way of 1 in 1 s.
const double smooth_step_acceleration = 10.0 / std::sqrt(3.0);

/// Of smooth_step along `way`.
double slow_time(double way, double speed, double acceleration)
{
  return std::max({shortest_time, smooth_step_peak * way / speed,
                   std::sqrt(smooth_step_acceleration * way / acceleration)});
}

/// From one pose to the other, in the first one's frame.
Vector6 way(const Vector6 & from, const std::vector<double> & to)
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

double slow_joint_time(const Vector6 & from, const std::vector<double> & to)
{
  double longest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    longest = std::max(longest, std::abs(to[i] - from[i]));
  }
  return slow_time(longest, default_joint_speed, default_joint_acceleration);
}

double slow_tcp_time(const Vector6 & from, const std::vector<double> & to)
{
  const Vector6 part = way(from, to);
  const double distance = std::hypot(part[0], part[1], part[2]);
  const double angle = std::hypot(part[3], part[4], part[5]);
  return std::max(slow_time(distance, default_linear_speed, default_linear_acceleration),
                  slow_time(angle, default_angular_speed, default_angular_acceleration));
}

Outcome servo(Run & run, double duration, const std::function<void(double share, double cycle)> & send,
              const std::function<Outcome()> & arrival, double deceleration)
{
  const auto version = run.robot().version();
  const double cycle = 1.0 / (version ? version->frequency() : 500.0);
  Sample sample = run.state();
  for (double time = 0.0; time < duration;) {
    const double before = sample.controller_time;
    if (auto why = run.next(sample)) {
      return *why;
    }
    time += std::clamp(sample.controller_time - before, 0.0, 2.0 * cycle);
    run.progress(smooth_step(std::min(time / duration, 1.0)));
    send(run.progress(), cycle);
  }
  return end_servo(run, arrival(), deceleration);
}

Outcome end_servo(Run & run, const Outcome & arrival, double deceleration)
{
  if (arrival) {
    run.control()->servoStop(deceleration);
  }
  return arrival;
}

std::vector<double> joints_between(const Vector6 & from, const std::vector<double> & to, double s)
{
  std::vector<double> joints(from.begin(), from.end());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] += s * (to[i] - from[i]);
  }
  return joints;
}

std::vector<double> pose_between(const Vector6 & from, const std::vector<double> & to, double s)
{
  Vector6 part = way(from, to);
  for (double & value : part) {
    value *= s;
  }
  const Vector6 pose = pose_trans(from, part);
  return {pose.begin(), pose.end()};
}

void check_tcp_speed(Check & check, const Vector6 & from, const std::vector<double> & to, double time)
{
  const Vector6 part = way(from, to);
  const double linear = smooth_step_peak * std::hypot(part[0], part[1], part[2]);
  const double angular = smooth_step_peak * std::hypot(part[3], part[4], part[5]);
  const double shortest = std::max(linear / highest_linear_speed, angular / highest_angular_speed);
  check.that(time >= shortest,
             fmt::format(
                 "the TCP would need {:.3f} m/s and {:.3f} rad/s to get to pose in {:.3f} s, its limits "
                 "are {} m/s and {} rad/s: use a time of at least {:.3f} s",
                 linear / time, angular / time, time, highest_linear_speed, highest_angular_speed, shortest));
}

}  // namespace ur_ros_rtde
