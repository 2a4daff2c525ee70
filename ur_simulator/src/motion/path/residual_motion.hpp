#pragma once

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"

namespace ur_simulator {

/// Lowest deceleration (rad/s^2, m/s^2) of the velocity that a new motion takes over, however gently the new
/// motion accelerates. Otherwise a gentle motion would carry the arm far off its path.
constexpr double min_takeover_deceleration = 4.0;

/// The velocity of the previous motion while it decays: each axis decelerates to 0 at a constant rate. A path
/// that begins at rest is superposed, so that the velocity is continuous and the sum ends exactly at the
/// target.
class ResidualMotion {
 public:
  ResidualMotion() = default;
  /// Each axis has its own deceleration (> 0).
  ResidualMotion(const Vector6 & velocity, const Vector6 & deceleration);

  void advance(double duration) { time_ += duration; }
  Vector6 displacement() const;
  Vector6 velocity() const;
  /// Displacement when the velocity has decayed to 0.
  Vector6 total_displacement() const;
  bool finished() const;

 private:
  Vector6 velocity_ = Vector6::Zero();
  Vector6 deceleration_ = Vector6::Ones();
  double time_ = 0.0;
};

/// Decelerations for the current joint velocity: `preferred`, and more where a joint would otherwise exceed
/// its position limit.
Vector6 residual_deceleration(const RobotModel & model, const Setpoint & setpoint, double preferred);

}  // namespace ur_simulator
