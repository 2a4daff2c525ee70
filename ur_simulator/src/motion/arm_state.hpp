#pragma once

#include "dynamics/dynamics.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/follower.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Writes what follows from the joints' motion into the state: accelerations, torques, currents, TCP poses
/// and speeds, and what the accelerometer in the flange feels.
class ArmStateWriter {
 public:
  ArmStateWriter(const RobotModel & model, double cycle_time);

  void write(const Setpoint & target, const Follower & actual, ControllerState & state);
  /// After a leap (teleport): no acceleration is derived from the cycle before.
  void forget();

 private:
  void write_joints(const Vector6 & position, const Vector6 & velocity, JointState & joints) const;
  void write_target(ControllerState & state) const;
  void write_actual(ControllerState & state);

  const RobotModel & model_;
  double cycle_time_;
  Dynamics dynamics_;
  Vector3 flange_velocity_ = Vector3::Zero();
  bool first_ = true;
};

}  // namespace ur_simulator
