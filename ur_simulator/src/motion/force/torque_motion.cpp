#include "motion/force/torque_motion.hpp"

namespace ur_simulator {
namespace {

constexpr double holding_deceleration = 20.0;  // rad/s^2

}  // namespace

TorqueMotion::TorqueMotion(const RobotModel & model, ForwardDynamics & dynamics,
                           const ControllerState & state, const Vector6 & torque,
                           const Vector6 & viscous_scale, const Vector6 & coulomb_scale)
    : dynamics_(&dynamics),
      state_(&state),
      torque_(torque),
      friction_(JointFriction::of_gears(model).scaled(Vector6::Ones() - viscous_scale,
                                                      Vector6::Ones() - coulomb_scale))
{
}

std::optional<MotionFault> TorqueMotion::advance(const TimeStep & time_step, Setpoint & setpoint)
{
  const double step = holding_deceleration * time_step.duration;
  setpoint.velocity =
      applied_ ? Vector6(setpoint.velocity - setpoint.velocity.cwiseMax(-step).cwiseMin(step))
               : dynamics_->next_velocity(setpoint, torque_, friction_, time_step.duration, *state_);
  setpoint.position += setpoint.velocity * time_step.duration;
  finished_ = applied_ && setpoint.velocity.isZero(0.0);
  applied_ = true;
  return std::nullopt;
}

}  // namespace ur_simulator
