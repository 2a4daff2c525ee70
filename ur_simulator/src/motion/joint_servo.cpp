#include "motion/joint_servo.hpp"

#include <algorithm>
#include <cmath>

#include "motion/takeover.hpp"

namespace ur_simulator {

JointServo::JointServo(const RobotModel & model, const Vector6 & target, double time, double lookahead,
                       double gain)
    : model_(&model),
      target_(target),
      time_left_(time),
      gain_(gain),
      lookahead_(std::max(lookahead, 2.0 * least_damping / std::sqrt(gain)))
{
}

std::optional<MotionFault> JointServo::advance(const Tick & tick, Setpoint & now)
{
  time_left_ -= tick.duration * tick.speed_scaling;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double velocity = next_velocity(i, tick.duration, now);
    now.position[i] += velocity * tick.duration;
    now.velocity[i] = velocity;
  }
  if (now.velocity.cwiseAbs().maxCoeff() > 1e-6) {
    return std::nullopt;
  }
  if (braking_ || (released() && (target_ - now.position).cwiseAbs().maxCoeff() < 1e-6)) {
    now.velocity.setZero();
    done_ = true;
  }
  return std::nullopt;
}

double JointServo::next_velocity(Eigen::Index joint, double duration, const Setpoint & now) const
{
  const double velocity = now.velocity[joint];
  const double step = acceleration_limit * duration;
  if (braking_) {
    const double gentle = 2.5 * takeover_deceleration * duration;
    return velocity - std::clamp(velocity, -gentle, gentle);
  }
  const double way = target_[joint] - now.position[joint];
  // Backward Euler: stable for every gain and cycle time.
  double wanted = (velocity + duration * gain_ * way) / (1.0 + duration * gain_ * (duration + lookahead_));
  // Never so fast that the arm could not stop at the target, nor faster than the joint may turn.
  const double fastest =
      std::min(model_->velocity_max[joint], std::sqrt(1.8 * acceleration_limit * std::abs(way)));
  if (wanted * way > 0.0) {
    wanted = std::clamp(wanted, -fastest, fastest);
  }
  wanted = std::clamp(wanted, velocity - step, velocity + step);
  return std::clamp(wanted, -model_->velocity_max[joint], model_->velocity_max[joint]);
}

}  // namespace ur_simulator
