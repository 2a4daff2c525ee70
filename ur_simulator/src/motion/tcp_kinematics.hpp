#pragma once

#include <optional>

#include "kinematics/robot_model.hpp"
#include "motion/setpoint.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// Forward and inverse kinematics of one arm with one TCP offset. Cartesian motions use it to compute the
/// joint setpoint in every cycle, by closed-form inverse kinematics.
class TcpKinematics {
 public:
  TcpKinematics(const RobotModel & model, const Vector6 & tcp_offset);

  Transform tcp_pose(const Vector6 & joints) const;
  /// Velocity of the TCP in the base frame.
  Vector6 tcp_twist(const Setpoint & setpoint) const;
  /// The joint position nearest to `seed` that puts the TCP at `pose`; nothing if there is none within the
  /// limits.
  std::optional<Vector6> inverse(const Transform & pose, const Vector6 & seed) const;
  bool has_same_tool(const TcpKinematics & other) const;
  /// Moves the setpoint to the nearest joint position that puts the TCP at `pose`. Returns a fault, with
  /// `setpoint` unchanged, if a joint would exceed its speed limit or its velocity would jump.
  std::optional<MotionFault> move_to(const Transform & pose, double duration, Setpoint & setpoint) const;

 private:
  MotionFault unreachable_fault(const Vector6 & joints) const;

  const RobotModel * model_;
  Transform offset_;
  Transform offset_inverse_;
};

}  // namespace ur_simulator
