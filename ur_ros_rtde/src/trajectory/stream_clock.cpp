#include "ur_ros_rtde/trajectory/stream_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double slowest_change = 0.2;  // 1/s
constexpr double quickest_change = 4.0;
constexpr double bend = 40.0;  // 1/s^2, of the rate
/// Packages of one or two cycles are the network's jitter; what is more, the arm has waited for.
constexpr double tolerated_cycles = 2.0;

// How fast the rate r may change: |q'' r^2 + q' r'| <= A.
double room(const Point & point, double rate, const Limits & limits)
{
  const Joints left = limits.acceleration - point.acceleration.abs() * (rate * rate);
  const double most = (left / point.velocity.abs().max(1e-9)).minCoeff();
  return std::clamp(most, slowest_change, quickest_change);
}

}  // namespace

void StreamClock::advance(double elapsed, double wanted, const Point & point, const Limits & limits)
{
  const double duration = std::clamp(elapsed, 0.0, tolerated_cycles * cycle_);
  wait_out(elapsed - duration);
  const double before = rate_;
  change_rate(duration, std::clamp(wanted, 0.0, 1.0), room(point, rate_, limits));
  time_ += 0.5 * (before + rate_) * duration;
}

// The target stood still: the controller, which follows it with its memory, has slowed the arm down.
void StreamClock::wait_out(double late)
{
  if (late > 0.0) {
    rate_ *= std::max(0.0, 1.0 - late / memory_);
    change_ = 0.0;
  }
}

void StreamClock::change_rate(double duration, double wanted, double quickest)
{
  const double missing = wanted - rate_;
  // Not faster than what can be taken back until the wanted rate is reached.
  const double target = std::copysign(std::min(quickest, std::sqrt(2.0 * bend * std::abs(missing))), missing);
  change_ += std::clamp(target - change_, -bend * duration, bend * duration);
  const double step = change_ * duration;
  const bool arrives = std::abs(missing) <= std::max(std::abs(step), 1e-4);
  if (arrives) {
    rate_ = wanted;
    change_ = 0.0;
  } else {
    rate_ = std::clamp(rate_ + step, 0.0, 1.0);
  }
}

}  // namespace ur_ros_rtde::trajectory
