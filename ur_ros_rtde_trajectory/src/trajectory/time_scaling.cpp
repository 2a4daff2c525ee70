#include "ur_ros_rtde_trajectory/time_scaling.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

/// 1/s, the ramp of the controller's speed slider. With a lower limit, a busy host could prevent any motion.
constexpr double lowest_rate_dot_limit = 2.0;
constexpr double highest_rate_dot_limit = 20.0;
constexpr double lowest_rate_ddot_limit = 100.0;  // 1/s^2, of the rate
constexpr double highest_rate_ddot_limit = 1000.0;

// Margin between `used` and `limit`, relative to the joint velocities.
double available(const Joints & limit, const Joints & used, const Point & point)
{
  return ((limit - used) / point.velocity.abs().max(1e-9)).minCoeff();
}

// Margins of the acceleration and the jerk beside those of the plan at rate `r`.
double acceleration_margin(const Point & point, const Limits & limits, double r)
{
  return available(limits.acceleration, point.acceleration.abs() * (r * r), point);
}
double jerk_margin(const Point & point, const Limits & limits, double r)
{
  return available(limits.jerk, point.jerk.abs() * (r * r * r), point);
}

}  // namespace

void TimeScaling::advance(double elapsed, double target_rate, const Point & point, const Limits & limits)
{
  const double duration = std::clamp(elapsed, 0.0, servo_.bridged_cycles * servo_.cycle);
  slow_for_delay(elapsed - duration);
  const double before = rate_;
  const double whole_acceleration = acceleration_margin(point, limits, 0.0);
  const double whole_jerk = jerk_margin(point, limits, 0.0);
  const Bounds bounds{std::clamp(acceleration_margin(point, limits, rate_),
                                 std::min(whole_acceleration, lowest_rate_dot_limit), highest_rate_dot_limit),
                      std::clamp(jerk_margin(point, limits, rate_),
                                 std::min(whole_jerk, lowest_rate_ddot_limit), highest_rate_ddot_limit)};
  update_rate(duration, std::clamp(target_rate, 0.0, 1.0), bounds);
  time_ += 0.5 * (before + rate_) * duration;
}

// While the setpoint was constant, the controller has slowed the arm down with its servo lag. The setpoint,
// which is at time + lead * rate of the plan, does not jump while the plan has a constant velocity.
void TimeScaling::slow_for_delay(double delay)
{
  if (delay > 0.0) {
    const double before = rate_;
    rate_ *= std::max(0.0, 1.0 - delay / servo_.lag);
    rate_dot_ = std::max(rate_dot_, 0.0);
    time_ += servo_.lead * (before - rate_);
  }
}

void TimeScaling::update_rate(double duration, double target_rate, const Bounds & bounds)
{
  const double remaining = target_rate - rate_;
  // Limits the rate of change so that it can return to zero when the target rate is reached.
  const double target_rate_dot = std::copysign(
      std::min(bounds.rate_dot, std::sqrt(2.0 * bounds.rate_ddot * std::abs(remaining))), remaining);
  const double max_change = bounds.rate_ddot * duration;
  rate_dot_ += std::clamp(target_rate_dot - rate_dot_, -max_change, max_change);
  const double step = rate_dot_ * duration;
  const bool approaches = step * remaining > 0.0;
  const bool arrives = std::abs(remaining) <= (approaches ? std::max(std::abs(step), 1e-4) : 1e-4);
  if (arrives) {
    rate_ = target_rate;
    rate_dot_ = 0.0;
  } else {
    rate_ = std::clamp(rate_ + step, 0.0, 1.0);
  }
}

}  // namespace ur_ros_rtde::trajectory
