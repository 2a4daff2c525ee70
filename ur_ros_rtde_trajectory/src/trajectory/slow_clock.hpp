#pragma once

#include <optional>
#include <vector>

#include "trajectory/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// A stop slows the clock of a planned motion: where the plan is at time p, the arm comes later, on the same
/// path. Its joints then move with q' r, q'' r^2 + q' r', q''' r^3 + 3 q'' r r' + q' r'' for a clock rate r =
/// dp/dt.
struct ClockState {
  double planned = 0.0;  ///< s, what the clock shows
  double rate = 1.0;     ///< r
  double change = 0.0;   ///< r', 1/s

  ClockState after(double time, double bend) const
  {
    return {planned + time * (rate + time * (change / 2.0 + time * bend / 6.0)),
            rate + time * (change + time * bend / 2.0), change + time * bend};
  }
};

/// r'' is constant in each phase. After the last one the clock stands still.
struct SlowClock {
  struct Phase {
    double begin = 0.0;  // s, since the braking began
    double bend = 0.0;   // r'', 1/s^2
    ClockState state;    // at its beginning
  };
  std::vector<Phase> phases;
  double end = 0.0;  ///< s

  ClockState at(double time) const;
  double bend_at(double time) const { return phase_at(time).bend; }
  /// When the clock shows `planned`.
  double when(double planned) const;

 private:
  const Phase & phase_at(double time) const;
};

/// The clock that stops the motion soonest, beginning at `planned`, of those that brake at each moment as
/// hard as the limits and the way back to a constant rate allow (any constant rate keeps the limits that the
/// plan keeps). None when the plan comes to rest before any. `reserve`: part of the limits that braking does
/// not use (the plan may), for what happens between the moments looked at.
std::optional<SlowClock> find_slow_clock(const Motion & plan, double planned, const Limits & limits,
                                         double reserve);

}  // namespace ur_ros_rtde::trajectory
