#pragma once

#include "dynamics/dynamics.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Viscous friction, N m/(rad/s), and Coulomb friction, N m, of each joint.
struct JointFriction {
  Vector6 viscous;
  Vector6 coulomb;

  /// Friction of the gears. UR does not publish it; these are estimates by joint size, of the order that
  /// identifications of UR arms report.
  static JointFriction of_gears(const RobotModel & model);
  JointFriction scaled(const Vector6 & viscous_scale, const Vector6 & coulomb_scale) const;
};

/// Up to six linear constraints on the joint velocity. Fixed-capacity matrices: no allocation.
using ConstraintJacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
using ConstraintVelocity = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// Motion of the arm under joint torques. The controller compensates gravity for the payload that it was
/// told; the rest of the load and the contact forces act through state.tool_wrench.
class ForwardDynamics {
 public:
  explicit ForwardDynamics(const RobotModel & model);

  /// The joint velocity one cycle later. Friction is integrated implicitly, so that an arm at rest stays at
  /// rest until its friction is overcome.
  Vector6 next_velocity(const Setpoint & setpoint, const Vector6 & torque, const JointFriction & friction,
                        double duration, const ControllerState & state);
  /// The velocity with jacobian * velocity = target that differs least in kinetic energy from `velocity`, the
  /// result of the last next_velocity().
  Vector6 constrained_velocity(const Vector6 & velocity, const ConstraintJacobian & jacobian,
                               const ConstraintVelocity & target) const;

 private:
  const RobotModel & model_;
  Dynamics dynamics_;
  Vector6 rotor_inertia_;                            ///< kg m^2 at the joint, after the gear
  Matrix6 effective_inertia_ = Matrix6::Identity();  ///< inertia plus duration * friction of the last step
};

}  // namespace ur_simulator
