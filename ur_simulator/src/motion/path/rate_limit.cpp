#include "motion/path/rate_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/robot_model.hpp"

namespace ur_simulator {
namespace {

constexpr double speed_margin = 0.95;  // of the joint speed limit: between the samples a joint may be faster
constexpr double min_rate = 0.2;
constexpr double fast_path = 1.0;            // m/s or rad/s
constexpr double acceleration_margin = 1.5;  // times the limit; twice the limit is a fault
constexpr double max_rate_change = 3.0;      // 1/s

/// Below this rate, a path leads through a singularity. The time of a motion may ask for any speed.
double lowest_rate(const SpeedProfile & profile)
{
  const double peak_speed = profile.sample(0.5 * profile.duration()).speed;
  return min_rate * std::min(1.0, fast_path / std::max(peak_speed, 1e-9));
}

double rate_of_speed(const RobotModel & model, const Vector6 & speed)
{
  return speed_margin / std::max(speed.cwiseAbs().cwiseQuotient(model.velocity_max).maxCoeff(), 1e-9);
}

/// A path at the rate r has r^2 times the acceleration.
double rate_of_change(const RobotModel & model, const Vector6 & change_of_speed, double duration)
{
  const double ratio = change_of_speed.cwiseAbs().cwiseQuotient(model.acceleration_max).maxCoeff() / duration;
  return std::sqrt(acceleration_margin / std::max(ratio, 1e-9));
}

}  // namespace

RateLimit::RateLimit(const RobotModel & model, const TcpKinematics & kinematics, const TcpSegment & path,
                     const SpeedProfile & profile, const Vector6 & near_start)
    : interval_(profile.duration() / static_cast<double>(intervals))
{
  rates_.fill(1.0);
  const auto start = kinematics.inverse(path.at(0.0), near_start);
  if (!start) {
    return;
  }
  const double lowest = lowest_rate(profile);
  Vector6 joints = *start;
  Vector6 previous_speed = Vector6::Zero();
  // From rest, the mean speed of the first interval is reached in its middle.
  const double change_at_start =
      profile.sample(0.0).speed > 0.0 ? std::numeric_limits<double>::infinity() : 0.5 * interval_;
  for (std::size_t i = 0; i < intervals; ++i) {
    const double end = interval_ * static_cast<double>(i + 1);
    const auto next = kinematics.inverse(path.at(profile.sample(end).distance), joints);
    if (!next) {
      break;  // the motion fails there
    }
    const Vector6 speed = (*next - joints) / interval_;
    const double change = i == 0 ? change_at_start : interval_;
    const double rate = std::clamp(
        std::min(rate_of_speed(model, speed), rate_of_change(model, speed - previous_speed, change)), lowest,
        1.0);
    previous_speed = speed;
    rates_[i] = std::min(rates_[i], rate);
    rates_[i + 1] = rate;
    limits_ = limits_ || rate < 1.0;
    joints = *next;
  }
  if (limits_) {
    bound_rate_of_change();
  }
}

void RateLimit::bound_rate_of_change()
{
  // With time_of_path' = rate, a change of the rate by c per second changes rate^2 by 2 c per second of the
  // path.
  const double change = 2.0 * max_rate_change * interval_;
  const auto bounded = [change](double rate, double neighbor) {
    return std::min(rate, std::sqrt(neighbor * neighbor + change));
  };
  for (std::size_t i = intervals; i-- > 0;) {
    rates_[i] = bounded(rates_[i], rates_[i + 1]);
  }
  for (std::size_t i = 0; i < intervals; ++i) {
    rates_[i + 1] = bounded(rates_[i + 1], rates_[i]);
  }
}

double RateLimit::at(double time) const
{
  if (!limits_) {
    return 1.0;
  }
  const double position = std::clamp(time / interval_, 0.0, static_cast<double>(intervals));
  const auto index = std::min(static_cast<std::size_t>(position), intervals - 1);
  const double fraction = position - static_cast<double>(index);
  return (1.0 - fraction) * rates_[index] + fraction * rates_[index + 1];
}

}  // namespace ur_simulator
