#pragma once

#include <stop_token>
#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// Segment of a path between two stops, given as closely spaced samples of a smooth curve, for example the
/// result of inverse kinematics along a Cartesian path.
struct SampledSegment {
  std::vector<double> parameters;     ///< path parameter of each sample, chosen by the caller; increasing
  std::vector<Joints> positions;      ///< rad; at least one; the first is where the previous segment ends
  std::vector<double> min_durations;  ///< s; minimum duration of each interval, one fewer than positions
};

/// Plans the time-optimal motion through the samples, with a stop between two segments, within `limits` (as
/// plan_path) and the minimum durations. `waypoints` are the path parameters, in non-decreasing order, that
/// count as waypoints of the trajectory. `stop` cancels planning. Returns an error for segments whose lists
/// do not fit, or whose numbers are not finite.
Expected<Trajectory> plan_sampled(const std::vector<SampledSegment> & segments,
                                  const std::vector<double> & waypoints, const Limits & limits,
                                  const std::stop_token & stop = {});

}  // namespace ur_ros_rtde::trajectory
