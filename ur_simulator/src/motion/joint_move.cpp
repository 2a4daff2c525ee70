#include "motion/joint_move.hpp"

#include <algorithm>

namespace ur_simulator {
namespace {

/// The leading joint's speed at which the first joint reaches its own limit.
double speed_limit(const RobotModel & model, const Vector6 & direction)
{
  return model.velocity_max.cwiseQuotient(direction.cwiseAbs().cwiseMax(1e-9)).minCoeff();
}

}  // namespace

JointMove::JointMove(const RobotModel & model, const Setpoint & from, const Vector6 & target,
                     const MoveOptions & options)
    : start_(from.position), target_(target)
{
  const double brisk = std::max(options.acceleration, takeover_deceleration);
  runout_ = Runout(from.velocity, runout_deceleration(model, from, brisk));
  const Vector6 way = target - from.position - runout_.total();
  const double longest = way.cwiseAbs().maxCoeff();
  if (longest < 1e-12) {
    return;
  }
  direction_ = way / longest;
  const double limit = speed_limit(model, direction_);
  const double acceleration_limit = model.acceleration_max.minCoeff();
  const double acceleration = std::min(options.acceleration, acceleration_limit);
  if (options.time > 0.0) {
    profile_ = TrapezoidProfile::in_time(longest, options.time, acceleration, limit, acceleration_limit);
  } else {
    profile_ = TrapezoidProfile(longest, std::min(options.velocity, limit), acceleration);
  }
}

std::optional<MotionFault> JointMove::advance(const Tick & tick, Setpoint & now)
{
  runout_.advance(tick.duration);
  clock_.advance(tick.duration, tick.speed_scaling);
  const auto along = profile_.at(clock_.time());
  now.position = start_ + runout_.displacement() + along.distance * direction_;
  now.velocity = runout_.velocity() + along.speed * clock_.rate() * tick.speed_scaling * direction_;
  if (runout_.over() && clock_.time() >= profile_.duration()) {
    now = {target_, Vector6::Zero()};
    done_ = true;
  } else if (runout_.over() && clock_.stopped()) {
    now.velocity.setZero();
    done_ = true;
  }
  return std::nullopt;
}

void JointMove::brake()
{
  clock_.brake(profile_.at(clock_.time()).speed, std::max(profile_.acceleration(), takeover_deceleration));
}

}  // namespace ur_simulator
