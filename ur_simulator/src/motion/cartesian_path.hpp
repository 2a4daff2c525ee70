#pragma once

#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// Leads the joints so that the TCP is where a Cartesian motion wants it, by closed-form inverse kinematics
/// every cycle.
class CartesianPath {
 public:
  CartesianPath(const RobotModel & model, const Vector6 & tcp_offset);

  Transform tcp(const Vector6 & joints) const;
  /// Velocity of the TCP, base frame.
  Vector6 twist(const Setpoint & now) const;
  /// The posture nearest to `seed` that puts the TCP at `pose`; nothing when there is none within the limits.
  std::optional<Vector6> joints(const Transform & pose, const Vector6 & seed) const;
  /// Do both lead the same point of the tool?
  bool same_tool(const CartesianPath & other) const;
  /// Moves the joints to the posture that puts the TCP at `pose`; refused, with `now` unchanged, when a joint
  /// would have to leap.
  std::optional<MotionFault> follow(const Transform & pose, double duration, Setpoint & now) const;

 private:
  MotionFault out_of_reach(const Vector6 & joints) const;

  const RobotModel * model_;
  Transform offset_;
  Transform offset_inverse_;
};

}  // namespace ur_simulator
