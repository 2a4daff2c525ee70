#pragma once

#include <optional>
#include <string>

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {

enum class Quantity { position, velocity, acceleration, jerk, path_speed };

/// Limits reduced by a relative margin, for rounding errors in planning and verification.
inline Limits with_margin(Limits limits, double margin = 1e-4)
{
  limits.velocity *= 1.0 - margin;
  limits.acceleration *= 1.0 - margin;
  limits.jerk *= 1.0 - margin;
  return limits;
}

/// Value of one joint at one time that exceeds its limit. For path_speed: the ratio to the maximum speed.
struct LimitViolation {
  Quantity quantity = Quantity::position;
  int joint = 0;
  double time = 0.0, value = 0.0, limit = 0.0;
};

/// Largest utilization of the limits in a piece of the timing law: at both ends, at `inner` points, and the
/// estimated maxima between them.
struct PieceUtilization {
  Joints velocity, acceleration, jerk;  // largest |value| / limit of each joint
  double speed = 0.0;                   // ratio to the maximum speed of the path
};

inline constexpr double verification_step = 0.004;  // s

PieceUtilization piece_utilization(const Motion & motion, const TimingLawPiece & piece, const Limits & limits,
                                   int inner);

/// Largest utilization of the limits by the pieces of a motion from `begin` on, at the points that
/// first_violation checks by default.
Utilization max_utilization(const Motion & motion, std::size_t begin, const Limits & limits);

/// First violation of a limit, checked in steps of at most `step` seconds. `use` receives the largest
/// utilization.
std::optional<LimitViolation> first_violation(const Motion & motion, const Limits & limits, double step,
                                              Utilization & use);

/// The same for one piece.
std::optional<LimitViolation> first_violation(const Motion & motion, const TimingLawPiece & piece,
                                              const Limits & limits, double step, Utilization & use);

/// Fails if the motion is longer than max_duration.
Status check_duration(const Motion & motion);

/// Describes a violation: "velocity of elbow_joint is 3.2 rad/s at 1.25 s (after waypoint 7), its limit 3.14
/// rad/s".
std::string describe(const LimitViolation & excess, std::size_t waypoint);

}  // namespace ur_ros_rtde::trajectory
