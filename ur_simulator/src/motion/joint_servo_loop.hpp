#pragma once

#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// Servo loops of the joints: the actual position follows the target as a first-order lag. A joint at
/// constant velocity trails by lag() times its velocity; a joint at rest has no error.
class JointServoLoop {
 public:
  /// s; 0.5 ms in recordings of a UR5e, 0.24 ms in those of a UR5 (CB3).
  static constexpr double lag(Series series) { return series == Series::cb3 ? 0.24e-3 : 0.5e-3; }

  JointServoLoop(Series series, double cycle_time, const Vector6 & position);
  void advance(const Vector6 & target);
  /// Puts the joints at a position, at rest.
  void jump_to(const Vector6 & position);
  /// Sets the actual state directly while the joints are torque controlled.
  void set_state(const Vector6 & position, const Vector6 & velocity);
  /// The mechanical brakes hold the joints.
  void hold() { velocity_.setZero(); }

  const Vector6 & position() const { return position_; }
  const Vector6 & velocity() const { return velocity_; }

 private:
  double cycle_time_;
  double gain_;
  Vector6 position_;
  Vector6 velocity_ = Vector6::Zero();
};

}  // namespace ur_simulator
