#include "motion/follower.hpp"

#include <cmath>

namespace ur_simulator {

Follower::Follower(double cycle_time, const Vector6 & position)
    : cycle_time_(cycle_time), gain_(1.0 - std::exp(-cycle_time / lag)), position_(position)
{
}

void Follower::advance(const Vector6 & target)
{
  const Vector6 error = target - position_;
  // The last nanoradians at once, so that standing still means zero velocity.
  const Vector6 step = error.cwiseAbs().maxCoeff() < 1e-9 ? error : Vector6(gain_ * error);
  position_ += step;
  velocity_ = step.cwiseAbs().maxCoeff() < 1e-9 ? Vector6(Vector6::Zero()) : Vector6(step / cycle_time_);
}

void Follower::match(const Vector6 & position, const Vector6 & velocity)
{
  position_ = position;
  velocity_ = velocity;
}

void Follower::jump_to(const Vector6 & position)
{
  position_ = position;
  velocity_.setZero();
}

}  // namespace ur_simulator
