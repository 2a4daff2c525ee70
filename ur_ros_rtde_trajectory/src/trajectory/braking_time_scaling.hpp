#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "motion/motion.hpp"

namespace ur_ros_rtde::trajectory {

/// State of a time scaling p(t), which brakes a planned motion along its path. With the rate r = dp/dt, the
/// joints move with q' r, q'' r^2 + q' r' and q''' r^3 + 3 q'' r r' + q' r''.
struct TimeScalingState {
  double plan_time = 0.0;  ///< p, s
  double rate = 1.0;       ///< r
  double rate_dot = 0.0;   ///< r', 1/s

  TimeScalingState after(double time, double rate_ddot) const
  {
    return {plan_time + time * (rate + time * (rate_dot / 2.0 + time * rate_ddot / 6.0)),
            rate + time * (rate_dot + time * rate_ddot / 2.0), rate_dot + time * rate_ddot};
  }
};

/// Time scaling with constant r'' in each phase. After the last phase, the plan time is constant.
struct BrakingTimeScaling {
  struct Phase {
    double begin = 0.0;      // s, since the start of braking
    double rate_ddot = 0.0;  // r'', 1/s^2
    TimeScalingState state;  // at the start of the phase
  };
  std::vector<Phase> phases;
  double end = 0.0;  ///< s

  TimeScalingState at(double time) const;
  double rate_ddot_at(double time) const { return phase_at(time).rate_ddot; }
  /// Time at which the plan time is `plan_time`.
  double time_at(double plan_time) const;

 private:
  const Phase & phase_at(double time) const;
};

/// Finds the time scaling that stops the motion soonest, starting at `plan_time`, among those that at each
/// moment brake as hard as the limits allow while a recovery to a constant rate remains possible (the plan
/// keeps its limits at any constant rate). Returns nullopt if the plan comes to rest earlier, or if the
/// search has not ended by `deadline`. `reserve`: fraction of the limits that braking leaves unused, for
/// violations between the checked moments.
std::optional<BrakingTimeScaling> find_braking_time_scaling(const Motion & plan, double plan_time,
                                                            const Limits & limits, double reserve,
                                                            std::chrono::steady_clock::time_point deadline);

}  // namespace ur_ros_rtde::trajectory
