#include "motion/force/forward_dynamics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kinematics/forward_kinematics.hpp"

namespace ur_simulator {
namespace {

// Estimates, as fractions of the highest torque of the joint.
constexpr double viscous_fraction = 0.06;  // s/rad
constexpr double coulomb_fraction = 0.04;
constexpr double rotor_fraction = 0.001;     // s^2/rad
constexpr double min_friction_speed = 1e-3;  // rad/s: below, Coulomb friction is viscous

}  // namespace

JointFriction JointFriction::of_gears(const RobotModel & model)
{
  return {viscous_fraction * model.torque_max, coulomb_fraction * model.torque_max};
}

JointFriction JointFriction::scaled(const Vector6 & viscous_scale, const Vector6 & coulomb_scale) const
{
  return {viscous.cwiseProduct(viscous_scale), coulomb.cwiseProduct(coulomb_scale)};
}

ForwardDynamics::ForwardDynamics(const RobotModel & model)
    : model_(model), dynamics_(model), rotor_inertia_(rotor_fraction * model.torque_max)
{
}

Vector6 ForwardDynamics::next_velocity(const Setpoint & setpoint, const Vector6 & torque,
                                       const JointFriction & friction, double duration,
                                       const ControllerState & state)
{
  dynamics_.set_payload(state.payload);
  dynamics_.set_gravity(state.gravity);
  Matrix6 inertia = dynamics_.mass_matrix(setpoint.position);
  inertia.diagonal() += rotor_inertia_;
  const Vector6 external_torque =
      jacobian(model_, setpoint.position, state.tcp_offset).transpose() * state.tool_wrench;
  const Vector6 driving =
      torque + external_torque - dynamics_.coriolis_torques(setpoint.position, setpoint.velocity);
  effective_inertia_ = inertia;
  effective_inertia_.diagonal() +=
      duration * (friction.viscous +
                  friction.coulomb.cwiseQuotient(setpoint.velocity.cwiseAbs().cwiseMax(min_friction_speed)));
  return effective_inertia_.ldlt().solve(inertia * setpoint.velocity + duration * driving);
}

Vector6 ForwardDynamics::constrained_velocity(const Vector6 & velocity, const ConstraintJacobian & jacobian,
                                              const ConstraintVelocity & target) const
{
  // Fixed sizes compile and run faster: the rows of absent constraints are zero and have no effect.
  const Eigen::Index count = jacobian.rows();
  Matrix6 rows = Matrix6::Zero();
  rows.topRows(count) = jacobian;
  Vector6 error = rows * velocity;
  error.head(count) -= target;
  const Matrix6 response = effective_inertia_.ldlt().solve(Matrix6(rows.transpose()));
  // At a singularity some constraint cannot be met by any joint velocity; the regularization softens it.
  const Matrix6 mobility = rows * response + 1e-6 * Matrix6::Identity();
  return velocity - response * mobility.ldlt().solve(error);
}

}  // namespace ur_simulator
