#include "motion/forward_dynamics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kinematics/forward.hpp"

namespace ur_simulator {
namespace {

// Estimates, in parts of a joint's highest torque.
constexpr double viscous_part = 0.06;  // s/rad
constexpr double coulomb_part = 0.04;
constexpr double rotor_part = 0.001;  // s^2/rad
constexpr double creep = 1e-3;        // rad/s: slower than this, friction holds

}  // namespace

JointFriction JointFriction::of(const RobotModel & model)
{
  return {viscous_part * model.torque_max, coulomb_part * model.torque_max};
}

JointFriction JointFriction::scaled(const Vector6 & viscous_share, const Vector6 & coulomb_share) const
{
  return {viscous.cwiseProduct(viscous_share), coulomb.cwiseProduct(coulomb_share)};
}

ForwardDynamics::ForwardDynamics(const RobotModel & model)
    : model_(model), dynamics_(model), rotor_inertia_(rotor_part * model.torque_max)
{
}

Vector6 ForwardDynamics::next_velocity(const Setpoint & now, const Vector6 & torque,
                                       const JointFriction & friction, double duration,
                                       const ControllerState & state)
{
  dynamics_.set_payload(state.payload);
  dynamics_.set_gravity(state.gravity);
  Matrix6 inertia = dynamics_.mass_matrix(now.position);
  inertia.diagonal() += rotor_inertia_;
  const Vector6 from_outside =
      jacobian(model_, now.position, state.tcp_offset).transpose() * state.tool_wrench;
  const Vector6 driving = torque + from_outside - dynamics_.coriolis_torques(now.position, now.velocity);
  resistance_ = inertia;
  resistance_.diagonal() +=
      duration * (friction.viscous + friction.coulomb.cwiseQuotient(now.velocity.cwiseAbs().cwiseMax(creep)));
  return resistance_.ldlt().solve(inertia * now.velocity + duration * driving);
}

Vector6 ForwardDynamics::constrained_velocity(const Vector6 & velocity, const ConstraintRows & rows,
                                              const ConstraintValues & wanted) const
{
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
  const Columns pushed = resistance_.ldlt().solve(rows.transpose());
  Square mobility = rows * pushed;
  // In a singularity some direction cannot be held whatever the joints do: there, softly.
  mobility.diagonal().array() += 1e-6;
  return velocity - pushed * mobility.ldlt().solve(rows * velocity - wanted);
}

}  // namespace ur_simulator
