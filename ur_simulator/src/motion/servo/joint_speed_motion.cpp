#include "motion/servo/joint_speed_motion.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {

JointSpeedMotion::JointSpeedMotion(const RobotModel & model, const Vector6 & velocity, double acceleration,
                                   double time)
    : SpeedMotion(velocity.cwiseMin(model.velocity_max).cwiseMax(-model.velocity_max),
                  std::min(acceleration, model.acceleration_max.minCoeff()), time),
      model_(&model)
{
}

JointSpeedMotion JointSpeedMotion::stop(const RobotModel & model, double deceleration)
{
  return {model, Vector6::Zero(), deceleration, 0.0};
}

std::optional<MotionFault> JointSpeedMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  begin_cycle(time_step);
  Vector6 velocity =
      next_velocity(setpoint.velocity, [](const Vector6 & change) { return change.cwiseAbs().maxCoeff(); });
  if (const auto fault = keep_within_limits(time_step, setpoint, velocity)) {
    return fault;
  }
  setpoint.position += 0.5 * time_step.duration * (setpoint.velocity + velocity);
  setpoint.velocity = velocity;
  end_cycle(velocity);
  return std::nullopt;
}

std::optional<MotionFault> JointSpeedMotion::keep_within_limits(const TimeStep & time_step,
                                                                const Setpoint & setpoint,
                                                                Vector6 & velocity) const
{
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double limit = velocity[i] > 0.0 ? model_->position_max[i] : model_->position_min[i];
    // Distance that remains after this cycle if the joint keeps its velocity.
    const double distance = std::max(
        0.0, std::abs(limit - setpoint.position[i]) - time_step.duration * std::abs(setpoint.velocity[i]));
    const double stopping_speed = std::sqrt(0.8 * model_->acceleration_max[i] * distance);
    const double max_speed = std::max(
        stopping_speed, std::abs(setpoint.velocity[i]) - model_->acceleration_max[i] * time_step.duration);
    if (std::abs(velocity[i]) <= max_speed) {
      continue;
    }
    velocity[i] = std::copysign(max_speed, velocity[i]);
    if (max_speed < 0.02 && velocity[i] * target()[i] > 0.0) {
      return MotionFault{MotionFault::Kind::joint_position_limit, static_cast<int>(i), setpoint.position[i],
                         limit};
    }
  }
  return std::nullopt;
}

}  // namespace ur_simulator
