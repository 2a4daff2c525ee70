#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/force/forward_dynamics.hpp"
#include "motion/motion.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// direct_torque(): the joints are torque controlled for one cycle, gravity compensated. Unless another call
/// follows in the next cycle, position control takes over and stops the arm.
class TorqueMotion final : public Motion {
 public:
  /// Torques in N m; scales: the share (0..1 per joint) of viscous and Coulomb friction that the controller
  /// compensates.
  TorqueMotion(const RobotModel & model, ForwardDynamics & dynamics, const ControllerState & state,
               const Vector6 & torque, const Vector6 & viscous_scale, const Vector6 & coulomb_scale);

  std::optional<MotionFault> advance(const TimeStep & time_step, Setpoint & setpoint) override;
  bool call_complete() const override { return applied_; }
  bool finished() const override { return finished_; }
  void decelerate() override { applied_ = true; }
  bool controls_actual_joints() const override { return true; }

 private:
  ForwardDynamics * dynamics_;
  const ControllerState * state_;
  Vector6 torque_;
  JointFriction friction_;
  bool applied_ = false;
  bool finished_ = false;
};

}  // namespace ur_simulator
