#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr std::size_t max_waypoints = 10000;

struct PathOptions {
  /// Largest distance of the path from a waypoint, in the joint that deviates most, in rad. 0: the path
  /// passes through every waypoint.
  double blend_tolerance = 0.0;
  /// A waypoint where the direction in joint space changes by more than this angle is a corner: it is rounded
  /// within blend_tolerance; if that is 0, the motion stops there. A smooth spline passes through the other
  /// waypoints. In rad, 0 to pi; 0: straight lines only.
  double corner_angle = 0.35;
  /// Scales the time-optimal motion: velocities by the fraction, accelerations by its square. 0 < fraction <=
  /// 1.
  double speed_fraction = 1.0;
  /// Cancels planning.
  std::stop_token stop = {};
};

/// Performs the input checks of plan_path without planning: counts, sizes, finite numbers, position limits
/// and the limits themselves. Takes some milliseconds.
Status check_path(std::span<const std::vector<double>> waypoints, const Limits & limits);

/// Plans the time-optimal motion through joint positions without times, at rest at both ends. The result is
/// verified to keep `limits` in every joint at all times. The search for it ends after 3 s of processor
/// time: a long path with tight limits then takes more time than necessary. Without jerk limits
/// (`Limits::has_jerk`), accelerations may be discontinuous. A single waypoint, or repetitions of one
/// waypoint, results in a trajectory of duration 0.
///
/// Returns an error with field, waypoint, joint, value and limit if there is no waypoint or more than
/// `max_waypoints`, the number of joints is wrong, a number is not finite, a position exceeds its limits, or
/// limits or options are out of range.
Expected<Trajectory> plan_path(std::span<const std::vector<double>> waypoints, const Limits & limits,
                               const PathOptions & options = {});
Expected<Trajectory> plan_path(const std::vector<Joints> & waypoints, const Limits & limits,
                               const PathOptions & options = {});

}  // namespace ur_ros_rtde::trajectory
