#include "motion/servo/joint_servo_motion.hpp"

#include <algorithm>
#include <cmath>

#include "motion/path/residual_motion.hpp"

namespace ur_simulator {

JointServoMotion::JointServoMotion(const RobotModel & model, const Vector6 & target, double time,
                                   double lookahead, double gain)
    : model_(&model),
      target_(target),
      time_left_(time),
      gain_(gain),
      lookahead_(std::max(lookahead, 2.0 * min_damping_ratio / std::sqrt(gain)))
{
}

std::optional<MotionFault> JointServoMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  time_left_ -= time_step.duration * time_step.speed_scaling;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double velocity = next_velocity(i, time_step.duration, setpoint);
    setpoint.position[i] += velocity * time_step.duration;
    setpoint.velocity[i] = velocity;
  }
  if (setpoint.velocity.cwiseAbs().maxCoeff() > 1e-6) {
    return std::nullopt;
  }
  if (decelerating_ || (call_complete() && (target_ - setpoint.position).cwiseAbs().maxCoeff() < 1e-6)) {
    setpoint.velocity.setZero();
    finished_ = true;
  }
  return std::nullopt;
}

double JointServoMotion::next_velocity(Eigen::Index joint, double duration, const Setpoint & setpoint) const
{
  const double velocity = setpoint.velocity[joint];
  const double max_step = acceleration_limit * duration;
  if (decelerating_) {
    const double max_change = 2.5 * min_takeover_deceleration * duration;
    return velocity - std::clamp(velocity, -max_change, max_change);
  }
  const double error = target_[joint] - setpoint.position[joint];
  // Backward Euler: stable for every gain and cycle time.
  double next = (velocity + duration * gain_ * error) / (1.0 + duration * gain_ * (duration + lookahead_));
  // Limit the speed so that the joint can stop at the target. A target that accelerates at the limit and
  // reverses is met, `lookahead` late, at half of acceleration * lookahead: up to that speed the filter alone
  // stops the joint.
  const double reversal_speed = 0.5 * acceleration_limit * lookahead_;
  const double stopping_speed = std::sqrt(1.8 * acceleration_limit * std::abs(error));
  const double max_speed = std::min(model_->velocity_max[joint], std::max(stopping_speed, reversal_speed));
  if (next * error > 0.0) {
    next = std::clamp(next, -max_speed, max_speed);
  }
  next = std::clamp(next, velocity - max_step, velocity + max_step);
  return std::clamp(next, -model_->velocity_max[joint], model_->velocity_max[joint]);
}

}  // namespace ur_simulator
