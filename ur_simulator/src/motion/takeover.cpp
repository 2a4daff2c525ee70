#include "motion/takeover.hpp"

#include <algorithm>
#include <cmath>

namespace ur_simulator {

Runout::Runout(const Vector6 & velocity, const Vector6 & deceleration)
    : velocity_(velocity), deceleration_(deceleration)
{
}

Vector6 Runout::displacement() const
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double time = std::min(time_, std::abs(velocity_[i]) / deceleration_[i]);
    result[i] = velocity_[i] * time - 0.5 * std::copysign(deceleration_[i], velocity_[i]) * time * time;
  }
  return result;
}

Vector6 Runout::velocity() const
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    result[i] = std::copysign(std::max(0.0, std::abs(velocity_[i]) - deceleration_[i] * time_), velocity_[i]);
  }
  return result;
}

Vector6 Runout::total() const
{
  return 0.5 * velocity_.cwiseProduct(velocity_.cwiseAbs()).cwiseQuotient(deceleration_);
}

bool Runout::over() const
{
  return (velocity_.cwiseAbs() - deceleration_ * time_).maxCoeff() <= 0.0;
}

Vector6 runout_deceleration(const RobotModel & model, const Setpoint & now, double wished)
{
  Vector6 result;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double speed = std::abs(now.velocity[i]);
    const double room = now.velocity[i] > 0.0 ? model.position_max[i] - now.position[i]
                                              : now.position[i] - model.position_min[i];
    const double needed = 0.5 * speed * speed / std::max(room, 1e-6);
    result[i] = std::min(std::max(wished, needed), model.acceleration_max[i]);
  }
  return result;
}

}  // namespace ur_simulator
