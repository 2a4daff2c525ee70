#pragma once

#include <optional>
#include <vector>

#include "trajectory/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// A stop slows the clock of a planned motion: where the plan is at time p, the arm comes later, on the same
/// path. Its joints then move with q' r, q'' r^2 + q' r', q''' r^3 + 3 q'' r r' + q' r'' for a clock rate r =
/// dp/dt.
struct TimeScalingState {
  double plan_time = 0.0;  ///< s, what the clock shows
  double rate = 1.0;       ///< r
  double rate_dot = 0.0;   ///< r', 1/s

  TimeScalingState after(double time, double rate_ddot) const
  {
    return {plan_time + time * (rate + time * (rate_dot / 2.0 + time * rate_ddot / 6.0)),
            rate + time * (rate_dot + time * rate_ddot / 2.0), rate_dot + time * rate_ddot};
  }
};

/// r'' is constant in each phase. After the last one the clock stands still.
struct BrakingTimeScaling {
  struct Phase {
    double begin = 0.0;      // s, since the braking began
    double rate_ddot = 0.0;  // r'', 1/s^2
    TimeScalingState state;  // at its beginning
  };
  std::vector<Phase> phases;
  double end = 0.0;  ///< s

  TimeScalingState at(double time) const;
  double rate_ddot_at(double time) const { return phase_at(time).rate_ddot; }
  /// When the clock shows `planned`.
  double time_at(double plan_time) const;

 private:
  const Phase & phase_at(double time) const;
};

/// The clock that stops the motion soonest, beginning at `planned`, of those that brake at each moment as
/// hard as the limits and the way back to a constant rate allow (any constant rate keeps the limits that the
/// plan keeps). None when the plan comes to rest before any. `reserve`: part of the limits that braking does
/// not use (the plan may), for what happens between the moments looked at.
std::optional<BrakingTimeScaling> find_braking_time_scaling(const Motion & plan, double plan_time,
                                                            const Limits & limits, double reserve);

}  // namespace ur_ros_rtde::trajectory
