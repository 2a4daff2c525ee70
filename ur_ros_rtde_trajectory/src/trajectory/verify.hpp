#pragma once

#include <optional>
#include <string>

#include "trajectory/motion.hpp"

namespace ur_ros_rtde::trajectory {

enum class Quantity { position, velocity, acceleration, jerk, path_speed };

/// Room for rounding, in what is planned and in what looks at it.
inline Limits with_margin(Limits limits, double margin = 1e-4)
{
  limits.velocity *= 1.0 - margin;
  limits.acceleration *= 1.0 - margin;
  limits.jerk *= 1.0 - margin;
  return limits;
}

/// A value of one joint at one time that is beyond its limit; of path_speed: the share of what is allowed.
struct LimitViolation {
  Quantity quantity = Quantity::position;
  int joint = 0;
  double time = 0.0, value = 0.0, limit = 0.0;
};

/// Largest uses of the limits in a time piece: at both ends, at `inner` points, and what is to be expected
/// between them.
struct PieceUtilization {
  Joints velocity, acceleration, jerk;  // largest |value| / limit of each joint
  double speed = 0.0;                   // of the path's own top speed
};

inline constexpr double verification_step = 0.004;  // s

PieceUtilization piece_utilization(const Motion & motion, const TimingLawPiece & piece, const Limits & limits,
                                   int inner);

/// Largest uses of the limits by the pieces of a motion from `begin` on, at the points where first_excess
/// looks by default.
Utilization max_utilization(const Motion & motion, std::size_t begin, const Limits & limits);

/// The first excess of a motion, seen in steps of at most `step` seconds; `use` receives the largest uses.
std::optional<LimitViolation> first_violation(const Motion & motion, const Limits & limits, double step,
                                              Utilization & use);

/// "velocity of elbow_joint is 3.2 rad/s at 1.25 s (after waypoint 7), its limit 3.14 rad/s: …"
std::string describe(const LimitViolation & excess, std::size_t waypoint);

}  // namespace ur_ros_rtde::trajectory
