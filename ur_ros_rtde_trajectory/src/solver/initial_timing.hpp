#pragma once

#include <optional>

#include "solver/jerk_solver.hpp"

namespace ur_ros_rtde::trajectory {

/// Initial timing of the jerk solver, from rest to rest, with the coefficients of its speed spline: the
/// TOPP-RA solution, smoothed over the time in which the joints build up their acceleration and slowed down
/// at both ends as constant jerk requires. It may exceed the jerk limits.
struct InitialTiming {
  Profile profile;
  std::vector<double> w;
  std::vector<double> highest_speed;  ///< without jerk limits, of each station; only set by initial_timing
};

/// `solver` is used to evaluate the limits.
InitialTiming initial_timing(const Grid & grid, const Limits & limits, JerkSolver & solver);

/// Initial timing from `profile`, with the coefficients of its speed spline.
InitialTiming initial_timing_from(const Grid & grid, Profile profile);

/// Looks for places where `profile` is far slower than `highest_speed`, the speed without jerk limits,
/// although neither the path nor an end requires it: local optima of the solver, which occur in very short
/// intervals. Replaces each of them by a smooth transition. The result exceeds the limits there. Returns
/// nullopt if there is none.
std::optional<Profile> lift_dips(const Grid & grid, const Profile & profile,
                                 const std::vector<double> & highest_speed);

}  // namespace ur_ros_rtde::trajectory
