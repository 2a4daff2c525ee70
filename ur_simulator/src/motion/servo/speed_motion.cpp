#include "motion/servo/speed_motion.hpp"

#include <algorithm>

#include "motion/path/residual_motion.hpp"

namespace ur_simulator {

SpeedMotion::SpeedMotion(const Vector6 & target, double acceleration, double time)
    : target_(target), acceleration_(acceleration), time_(time)
{
}

void SpeedMotion::begin_cycle(const TimeStep & time_step)
{
  duration_ = time_step.duration;
  scaling_ = time_step.speed_scaling;
  elapsed_ += scaling_ * duration_;
  if (time_ > 0.0 && elapsed_ > time_ + 0.5 * scaling_ * duration_) {
    decelerate();
  }
}

Vector6 SpeedMotion::next_velocity(const Vector6 & velocity,
                                   const std::function<double(const Vector6 &)> & size)
{
  constexpr double tolerance = 1e-9;
  const double last_scaling = last_scaling_.value_or(scaling_);
  const Vector6 target = scaling_ * target_;
  const bool is_scaled =
      last_scaling > tolerance && size(velocity) <= (1.0 + tolerance) * size(last_scaling * target_);
  const Vector6 now = is_scaled ? Vector6(velocity * (scaling_ / last_scaling)) : velocity;
  const Vector6 change = target - now;
  const double step = acceleration_ * duration_ * (is_scaled ? scaling_ * scaling_ : 1.0);
  const double missing = size(change);
  velocity_reached_ = missing <= step;
  return velocity_reached_ ? target : Vector6(now + change * (step / missing));
}

void SpeedMotion::end_cycle(const Vector6 & velocity)
{
  last_scaling_ = scaling_;
  const bool time_is_up = time_ > 0.0 && elapsed_ > time_ - 0.5 * scaling_ * duration_;
  call_complete_ = call_complete_ || time_is_up || (time_ <= 0.0 && velocity_reached_);
  finished_ = velocity.isZero(0.0) && target_.isZero(0.0);
}

void SpeedMotion::decelerate()
{
  target_.setZero();
  acceleration_ = std::max(acceleration_, min_takeover_deceleration);
  call_complete_ = true;
}

}  // namespace ur_simulator
