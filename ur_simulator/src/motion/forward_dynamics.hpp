#pragma once

#include "dynamics/dynamics.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Friction at the joints, N m/(rad/s) and N m.
struct JointFriction {
  Vector6 viscous;
  Vector6 coulomb;

  /// Of the gears. Not published; estimates of the order that identifications of UR arms report, by size of
  /// joint.
  static JointFriction of(const RobotModel & model);
  JointFriction scaled(const Vector6 & viscous_part, const Vector6 & coulomb_part) const;
};

/// Up to six linear conditions on the joints' velocity; no allocation.
using ConstraintRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;
using ConstraintValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// How the arm moves when torques, not positions, lead it. Gravity is held by the controller as far as it
/// knows the load; what it does not know, and the surroundings, act by state.tool_wrench.
class ForwardDynamics {
 public:
  explicit ForwardDynamics(const RobotModel & model);

  /// The joints' velocity one cycle later. Friction is integrated implicitly, so that an arm at rest stays
  /// there until its friction is overcome.
  Vector6 next_velocity(const Setpoint & now, const Vector6 & torque, const JointFriction & friction,
                        double duration, const ControllerState & state);
  /// That velocity, led by the least change of kinetic energy to `rows * velocity = wanted`.
  Vector6 constrained_velocity(const Vector6 & velocity, const ConstraintRows & rows,
                               const ConstraintValues & wanted) const;

 private:
  const RobotModel & model_;
  Dynamics dynamics_;
  Vector6 rotor_inertia_;                     ///< kg m^2 behind the gears
  Matrix6 resistance_ = Matrix6::Identity();  ///< inertia and friction of the last step
};

}  // namespace ur_simulator
