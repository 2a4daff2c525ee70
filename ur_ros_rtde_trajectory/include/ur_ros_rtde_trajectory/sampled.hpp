#pragma once

#include <stop_token>
#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

/// A part of a path, from one stop to the next, as closely spaced samples of a smooth curve: what inverse
/// kinematics make of the way of a tool.
struct SampledSegment {
  std::vector<double> parameters;     ///< of each sample, by the caller's own measure; increasing
  std::vector<Joints> positions;      ///< rad; at least two, the first where the block before ends
  std::vector<double> min_durations;  ///< s that each interval takes at least: one fewer than the positions
};

/// The fastest motion through these samples, with a stop between two blocks, that keeps `limits` as plan_path
/// does, and the shortest times of the intervals. `waypoints`: places that count as the waypoints of the
/// trajectory, not decreasing. `stop` ends the planning (canceled).
Expected<Trajectory> plan_sampled(const std::vector<SampledSegment> & segments,
                                  const std::vector<double> & waypoints, const Limits & limits,
                                  const std::stop_token & stop = {});

}  // namespace ur_ros_rtde::trajectory
