#pragma once

#include "timing/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// A timing from rest to rest to start the jerk solver from, and the coefficients of its speed spline: the
/// fastest timing without jerk limits, made smooth over the time that the joints need to build up their
/// acceleration, and slowed down at both ends as constant jerk does. It may exceed the jerk limits.
struct InitialTiming {
  Profile profile;
  std::vector<double> w;
};

InitialTiming initial_timing(const Grid & grid, const Limits & limits);

/// The coefficients of the speed spline that belongs to `profile`.
InitialTiming initial_timing_from(const Grid & grid, Profile profile);

}  // namespace ur_ros_rtde::trajectory
