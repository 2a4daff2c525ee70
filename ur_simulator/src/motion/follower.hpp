#pragma once

#include "motion/setpoint.hpp"
#include "state/controller_state.hpp"

namespace ur_simulator {

/// The joints' servo loops: the actual position follows the target as a first-order lag, p' = (target - p) /
/// lag. A joint that turns evenly thus stays `lag` times its velocity behind, and one that stands still has
/// no error.
class Follower {
 public:
  static constexpr double lag = 0.006;  ///< s

  Follower(double cycle_time, const Vector6 & position);
  void advance(const Vector6 & target);
  void jump_to(const Vector6 & position);
  /// The joints move by themselves, not by their servo loops.
  void match(const Vector6 & position, const Vector6 & velocity);
  /// The brakes hold the joints where they are.
  void freeze() { velocity_.setZero(); }

  const Vector6 & position() const { return position_; }
  const Vector6 & velocity() const { return velocity_; }

 private:
  double cycle_time_;
  double gain_;
  Vector6 position_;
  Vector6 velocity_ = Vector6::Zero();
};

}  // namespace ur_simulator
