#include "motion/profile.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {

TrapezoidProfile::TrapezoidProfile(double distance, double speed, double acceleration)
    : distance_(distance), acceleration_(acceleration)
{
  const double reached = std::min(speed, std::sqrt(distance * acceleration));
  if (!(reached > 0.0)) {
    return;
  }
  ramp_time_ = reached / acceleration;
  cruise_time_ = std::max(0.0, distance / reached - ramp_time_);
}

TrapezoidProfile TrapezoidProfile::in_time(double distance, double time, double acceleration,
                                           double speed_limit, double acceleration_limit)
{
  // A triangle needs 4 s / t^2 at least.
  const double least = 4.0 * distance / (time * time);
  const double used = std::min(std::max(acceleration, least), acceleration_limit);
  const double root = std::sqrt(std::max(0.0, used * used * time * time - 4.0 * used * distance));
  const double speed = 0.5 * (used * time - root);
  return {distance, std::min(speed, speed_limit), used};
}

TrapezoidProfile::Sample TrapezoidProfile::at(double time) const
{
  const double left = duration() - time;
  if (left <= 0.0) {
    return {distance_, 0.0};
  }
  if (left < ramp_time_) {
    return {distance_ - 0.5 * acceleration_ * left * left, acceleration_ * left};
  }
  const double ramp = std::clamp(time, 0.0, ramp_time_);
  const double cruise = std::max(0.0, time - ramp_time_);
  return {0.5 * acceleration_ * ramp * ramp + acceleration_ * ramp_time_ * cruise, acceleration_ * ramp};
}

void PathClock::brake(double speed, double deceleration)
{
  if (slowing_ > 0.0) {
    return;
  }
  // A path that has hardly begun to move stops at once; the bound keeps the division sane.
  slowing_ = deceleration / std::max(speed, 1e-9);
}

void PathClock::advance(double duration, double speed_scaling)
{
  const double before = rate_;
  rate_ = std::max(0.0, rate_ - slowing_ * duration);
  time_ += 0.5 * (before + rate_) * duration * speed_scaling;
}

}  // namespace ur_simulator
