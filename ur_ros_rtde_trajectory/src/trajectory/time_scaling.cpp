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
double available(const Joints & limit, const Joints & used, const Joints & velocity, double least,
                 double most)
{
  return std::clamp(((limit - used) / velocity.max(1e-9)).minCoeff(), least, most);
}

}  // namespace

void TimeScaling::advance(double elapsed, double target_rate, const Point & point, const Limits & limits)
{
  const double duration = std::clamp(elapsed, 0.0, servo_.bridged_cycles * servo_.cycle);
  slow_for_delay(elapsed - duration);
  const double before = rate_;
  const Joints velocity = point.velocity.abs();
  const double r = rate_;
  const double max_rate_dot = available(limits.acceleration, point.acceleration.abs() * (r * r), velocity,
                                        lowest_rate_dot_limit, highest_rate_dot_limit);
  const double max_rate_ddot = available(limits.jerk, point.jerk.abs() * (r * r * r), velocity,
                                         lowest_rate_ddot_limit, highest_rate_ddot_limit);
  update_rate(duration, std::clamp(target_rate, 0.0, 1.0), max_rate_dot, max_rate_ddot);
  time_ += 0.5 * (before + rate_) * duration;
}

// While the setpoint was constant, the controller has slowed the arm down with its servo lag. The setpoint,
// which is at time + lead * rate of the plan, does not jump.
void TimeScaling::slow_for_delay(double delay)
{
  if (delay > 0.0) {
    const double before = rate_;
    rate_ *= std::max(0.0, 1.0 - delay / servo_.lag);
    rate_dot_ = std::max(rate_dot_, 0.0);
    time_ += servo_.lead * (before - rate_);
  }
}

void TimeScaling::update_rate(double duration, double target_rate, double max_rate_dot, double max_rate_ddot)
{
  const double remaining = target_rate - rate_;
  // Limits the rate of change so that it can return to zero when the target rate is reached.
  const double target_rate_dot =
      std::copysign(std::min(max_rate_dot, std::sqrt(2.0 * max_rate_ddot * std::abs(remaining))), remaining);
  rate_dot_ += std::clamp(target_rate_dot - rate_dot_, -max_rate_ddot * duration, max_rate_ddot * duration);
  const double step = rate_dot_ * duration;
  const bool arrives = std::abs(remaining) <= std::max(std::abs(step), 1e-4);
  if (arrives) {
    rate_ = target_rate;
    rate_dot_ = 0.0;
  } else {
    rate_ = std::clamp(rate_ + step, 0.0, 1.0);
  }
}

}  // namespace ur_ros_rtde::trajectory
