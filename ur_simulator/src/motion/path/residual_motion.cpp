#include "motion/path/residual_motion.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {

ResidualMotion::ResidualMotion(const Vector6 & velocity, const Vector6 & deceleration)
    : velocity_(velocity), deceleration_(deceleration)
{
}

Vector6 ResidualMotion::displacement() const
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double time = std::min(time_, std::abs(velocity_[i]) / deceleration_[i]);
    result[i] = velocity_[i] * time - 0.5 * std::copysign(deceleration_[i], velocity_[i]) * time * time;
  }
  return result;
}

Vector6 ResidualMotion::velocity() const
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    result[i] = std::copysign(std::max(0.0, std::abs(velocity_[i]) - deceleration_[i] * time_), velocity_[i]);
  }
  return result;
}

Vector6 ResidualMotion::total_displacement() const
{
  return 0.5 * velocity_.cwiseProduct(velocity_.cwiseAbs()).cwiseQuotient(deceleration_);
}

bool ResidualMotion::finished() const
{
  return (velocity_.cwiseAbs() - deceleration_ * time_).maxCoeff() <= 0.0;
}

Vector6 residual_deceleration(const RobotModel & model, const Setpoint & setpoint, double preferred)
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double speed = std::abs(setpoint.velocity[i]);
    const double distance_to_limit = setpoint.velocity[i] > 0.0
                                         ? model.position_max[i] - setpoint.position[i]
                                         : setpoint.position[i] - model.position_min[i];
    const double required = 0.5 * speed * speed / std::max(distance_to_limit, 1e-6);
    result[i] = std::min(std::max(preferred, required), model.acceleration_max[i]);
  }
  return result;
}

}  // namespace ur_simulator
