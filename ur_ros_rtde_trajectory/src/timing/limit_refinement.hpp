#pragma once

#include "solver/jerk_solver.hpp"
#include "timing/resampling.hpp"

namespace ur_ros_rtde::trajectory {

/// Largest utilization of the limits in an interval of a grid, between its stations, too.
struct IntervalUtilization {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
  std::uint8_t binding_joints = 0;  ///< bit j: joint j nearly reaches its limit of acceleration or jerk

  bool too_long = false;  ///< a limit is exceeded by so much that the interval must be subdivided

  /// Factor by which the motion would have to be slowed down.
  double slowdown() const;
};

/// Utilization of the limits by the pieces of the timing law of `motion` from `begin` on, one for each
/// interval of a segment.
std::vector<IntervalUtilization> interval_utilization(const Motion & motion, std::size_t begin,
                                                      const Limits & limits);

/// Tightens the limits in the intervals in which they are slightly exceeded.
void tighten_limits(const std::vector<IntervalUtilization> & use, LimitFractions & fractions);

/// Subdivides the intervals that are too long. Returns the same motion (pieces of the timing law from `begin`
/// on, one for each interval) on the new grid, and adapts `fractions` to it.
ResampledMotion subdivide(const Motion & motion, std::size_t begin, const Grid & grid,
                          const std::vector<IntervalUtilization> & use, LimitFractions & fractions);

}  // namespace ur_ros_rtde::trajectory
