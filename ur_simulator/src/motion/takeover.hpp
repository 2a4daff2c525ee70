#pragma once

#include "common/types.hpp"
#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"

namespace ur_simulator {

/// At least this brisk (rad/s^2, m/s^2) a velocity runs out, however gently the motion that takes over
/// accelerates: else a gentle motion would carry the arm far off.
constexpr double takeover_deceleration = 4.0;

/// The velocity that a path motion finds when it takes over, running out: each axis decelerates evenly to 0.
/// A path from rest is laid over it, so that velocity goes on without a leap and the sum ends exactly at the
/// target.
class Runout {
 public:
  Runout() = default;
  /// All axes with their own deceleration (> 0).
  Runout(const Vector6 & velocity, const Vector6 & deceleration);

  void advance(double duration) { time_ += duration; }
  Vector6 displacement() const;
  Vector6 velocity() const;
  /// The displacement when all has run out.
  Vector6 total() const;
  bool over() const;

 private:
  Vector6 velocity_ = Vector6::Zero();
  Vector6 deceleration_ = Vector6::Ones();
  double time_ = 0.0;
};

/// Decelerations at which the joints' present velocity runs out: `wished`, and more where a joint would else
/// pass its limits.
Vector6 runout_deceleration(const RobotModel & model, const Setpoint & now, double wished);

}  // namespace ur_simulator
