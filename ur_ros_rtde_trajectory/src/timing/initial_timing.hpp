#pragma once

#include "timing/jerk_solver.hpp"

namespace ur_ros_rtde::trajectory {

/// Initial timing of the jerk solver, from rest to rest, with the coefficients of its speed spline: the
/// TOPP-RA solution, smoothed over the time in which the joints build up their acceleration and slowed down
/// at both ends as constant jerk requires. It may exceed the jerk limits.
struct InitialTiming {
  Profile profile;
  std::vector<double> w;
};

/// `solver` is used to evaluate the limits.
InitialTiming initial_timing(const Grid & grid, const Limits & limits, JerkSolver & solver);

/// Initial timing from `profile`, with the coefficients of its speed spline.
InitialTiming initial_timing_from(const Grid & grid, Profile profile);

}  // namespace ur_ros_rtde::trajectory
