#include "motion/joint_speed.hpp"

#include <algorithm>
#include <cmath>

#include "motion/takeover.hpp"

namespace ur_simulator {

JointSpeed::JointSpeed(const RobotModel & model, const Vector6 & velocity, double acceleration, double time)
    : model_(&model),
      target_(velocity.cwiseMin(model.velocity_max).cwiseMax(-model.velocity_max)),
      acceleration_(std::min(acceleration, model.acceleration_max.minCoeff())),
      time_(time)
{
}

JointSpeed JointSpeed::stop(const RobotModel & model, double deceleration)
{
  return {model, Vector6::Zero(), deceleration, 0.0};
}

std::optional<MotionFault> JointSpeed::advance(const Tick & tick, Setpoint & now)
{
  elapsed_ += tick.duration;
  if (time_ > 0.0 && elapsed_ > time_ + 0.5 * tick.duration) {
    brake();
  }
  const Vector6 change = target_ - now.velocity;
  const double largest = change.cwiseAbs().maxCoeff();
  const double step = acceleration_ * tick.duration;
  Vector6 velocity = largest > step ? Vector6(now.velocity + change * (step / largest)) : target_;
  const bool reached = largest <= step;
  if (const auto fault = keep_within_limits(tick, now, velocity)) {
    return fault;
  }
  now.position += 0.5 * tick.duration * (now.velocity + velocity);
  now.velocity = velocity;
  const bool time_is_up = time_ > 0.0 && elapsed_ > time_ - 0.5 * tick.duration;
  released_ = released_ || time_is_up || (time_ <= 0.0 && reached);
  done_ = now.velocity.isZero(0.0) && target_.isZero(0.0);
  return std::nullopt;
}

std::optional<MotionFault> JointSpeed::keep_within_limits(const Tick & tick, const Setpoint & now,
                                                          Vector6 & velocity) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double limit = velocity[i] > 0.0 ? model_->position_max[i] : model_->position_min[i];
    // What is left after this cycle, should the joint not slow down in it.
    const double room =
        std::max(0.0, std::abs(limit - now.position[i]) - tick.duration * std::abs(now.velocity[i]));
    const double stoppable = std::sqrt(0.8 * model_->acceleration_max[i] * room);
    const double fastest =
        std::max(stoppable, std::abs(now.velocity[i]) - model_->acceleration_max[i] * tick.duration);
    if (std::abs(velocity[i]) <= fastest) {
      continue;
    }
    velocity[i] = std::copysign(fastest, velocity[i]);
    if (fastest < 0.02 && velocity[i] * target_[i] > 0.0) {
      return MotionFault{MotionFault::Kind::joint_position_limit, static_cast<int>(i), now.position[i],
                         limit};
    }
  }
  return std::nullopt;
}

void JointSpeed::brake()
{
  target_.setZero();
  acceleration_ = std::max(acceleration_, takeover_deceleration);
  released_ = true;
}

}  // namespace ur_simulator
