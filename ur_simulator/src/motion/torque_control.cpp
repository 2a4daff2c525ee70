#include "motion/torque_control.hpp"

namespace ur_simulator {
namespace {

constexpr double holding_deceleration = 20.0;  // rad/s^2

}  // namespace

TorqueControl::TorqueControl(const RobotModel & model, ForwardDynamics & dynamics,
                             const ControllerState & state, const Vector6 & torque,
                             const Vector6 & viscous_scale, const Vector6 & coulomb_scale)
    : dynamics_(&dynamics),
      state_(&state),
      torque_(torque),
      friction_(
          JointFriction::of(model).scaled(Vector6::Ones() - viscous_scale, Vector6::Ones() - coulomb_scale))
{
}

std::optional<MotionFault> TorqueControl::advance(const Tick & tick, Setpoint & now)
{
  const double step = holding_deceleration * tick.duration;
  now.velocity = served_ ? Vector6(now.velocity - now.velocity.cwiseMax(-step).cwiseMin(step))
                         : dynamics_->next_velocity(now, torque_, friction_, tick.duration, *state_);
  now.position += now.velocity * tick.duration;
  done_ = served_ && now.velocity.isZero(0.0);
  served_ = true;
  return std::nullopt;
}

}  // namespace ur_simulator
