#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr std::size_t max_waypoints = 10000;

struct PathOptions {
  /// Largest distance of the path from a waypoint, in the joint that deviates most. rad, >= 0. 0: the path
  /// passes through every waypoint.
  double blend_tolerance = 0.0;
  /// With blend_tolerance 0: a waypoint where the direction in joint space changes by more than this is a
  /// corner, where the motion stops; through the others a smooth spline passes. rad, 0 to pi; 0: straight
  /// lines only.
  double corner_angle = 0.35;
  /// Of the fastest motion. 0 < fraction <= 1: velocities times fraction, accelerations times its square.
  double speed_fraction = 1.0;
  /// Ends the planning (canceled) between two parts of the path, when it is not wanted any more.
  std::stop_token stop = {};
};

/// What plan_path refuses without planning, in some milliseconds: count, sizes, numbers, positions, limits.
Status check_path(std::span<const std::vector<double>> waypoints, const Limits & limits);

/// The fastest motion through joint positions without times, at rest at both ends, that keeps `limits` in
/// every joint at every moment: it is verified before it is returned. Without jerk limits
/// (`Limits::has_jerk`) accelerations may jump. One waypoint, or only repetitions of one: a trajectory of
/// duration 0.
///
/// Refused, with field, waypoint, joint, value and limit: no waypoint or more than `max_waypoints`, a wrong
/// number of joints, a number that is not finite, a position beyond its limits, limits or options out of
/// range.
Expected<Trajectory> plan_path(std::span<const std::vector<double>> waypoints, const Limits & limits,
                               const PathOptions & options = {});
Expected<Trajectory> plan_path(const std::vector<Joints> & waypoints, const Limits & limits,
                               const PathOptions & options = {});

}  // namespace ur_ros_rtde::trajectory
