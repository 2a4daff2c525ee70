#pragma once

#include "dynamics/dynamics.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/joint_servo_loop.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Writes the quantities that follow from the joint motion into the state: accelerations, torques, currents,
/// TCP poses and speeds, and the reading of the accelerometer in the flange.
class ArmStateWriter {
 public:
  ArmStateWriter(const RobotModel & model, double cycle_time);

  void write(const Setpoint & target, const JointServoLoop & actual, ControllerState & state);
  /// Call after a discontinuity (teleport): the next write reports no acceleration.
  void reset();

 private:
  void write_joints(const Vector6 & position, const Vector6 & velocity, JointState & joints) const;
  void write_target(ControllerState & state) const;
  void write_actual(ControllerState & state);
  void add_energy(ControllerState & state) const;
  /// The time derivative of a velocity of which `previous` was the value in the previous cycle.
  template <typename Derived>
  Derived derivative(const Derived & velocity, const Derived & previous) const
  {
    return first_cycle_ ? Derived(Derived::Zero()) : Derived((velocity - previous) / cycle_time_);
  }

  const RobotModel & model_;
  double cycle_time_;
  Dynamics dynamics_;
  Vector3 flange_velocity_ = Vector3::Zero();
  bool first_cycle_ = true;
};

}  // namespace ur_simulator
