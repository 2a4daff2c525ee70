#include "ur_ros_rtde_trajectory/stream_clock.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

/// 1/s, as the controller's own ramp of the speed slider. Less would let a busy host stand still for ever.
constexpr double slowest_change = 2.0;
constexpr double quickest_change = 20.0;
constexpr double softest_bend = 100.0;  // 1/s^2, of the rate
constexpr double hardest_bend = 1000.0;
/// Packages of one or two cycles are the network's jitter; what is more, the arm has waited for.
constexpr double tolerated_cycles = 2.0;

// How much more a joint can take beside `used`, by how fast it moves.
double room(const Joints & limit, const Joints & used, const Joints & velocity, double least, double most)
{
  return std::clamp(((limit - used) / velocity.max(1e-9)).minCoeff(), least, most);
}

}  // namespace

void StreamClock::advance(double elapsed, double wanted, const Point & point, const Limits & limits)
{
  const double duration = std::clamp(elapsed, 0.0, tolerated_cycles * cycle_);
  wait_out(elapsed - duration);
  const double before = rate_;
  const Joints velocity = point.velocity.abs();
  const double r = rate_;
  const double change = room(limits.acceleration, point.acceleration.abs() * (r * r), velocity,
                             slowest_change, quickest_change);
  const double bend = room(limits.jerk, point.jerk.abs() * (r * r * r), velocity, softest_bend, hardest_bend);
  change_rate(duration, std::clamp(wanted, 0.0, 1.0), change, bend);
  time_ += 0.5 * (before + rate_) * duration;
}

// The target stood still: the controller, which follows it with its memory, has slowed the arm down.
void StreamClock::wait_out(double late)
{
  if (late > 0.0) {
    rate_ *= std::max(0.0, 1.0 - late / memory_);
    change_ = std::max(change_, 0.0);
  }
}

void StreamClock::change_rate(double duration, double wanted, double quickest, double bend)
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
