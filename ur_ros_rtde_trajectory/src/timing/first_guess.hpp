#pragma once

#include "timing/grid.hpp"

namespace ur_ros_rtde::trajectory {

/// A timing from rest to rest to start the jerk solver from, and the coefficients of its speed spline: the
/// fastest timing without jerk limits, made smooth over the time that the joints need to build up their
/// acceleration, and slowed down at both ends as constant jerk does. It may exceed the jerk limits.
struct Start {
  Profile profile;
  std::vector<double> w;
};

Start first_guess(const Grid & grid, const Limits & limits);

/// The coefficients of the speed spline that belongs to `profile`.
Start start_from(const Grid & grid, Profile profile);

}  // namespace ur_ros_rtde::trajectory
