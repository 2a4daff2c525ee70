#pragma once

#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr std::size_t max_timed_waypoints = 100000;

/// A motion whose times are given. All lists that are not empty have the same length.
struct TimedWaypoints {
  std::vector<double> times;                       ///< s, any spacing, strictly increasing, the first is 0
  std::vector<std::vector<double>> positions;      ///< rad, six values each; the first is where the arm is
  std::vector<std::vector<double>> velocities;     ///< rad/s; may be empty. Zero at both ends
  std::vector<std::vector<double>> accelerations;  ///< rad/s^2; may be empty; only together with velocities
};

/// What plan_timed refuses without planning: lengths, numbers, times, positions beyond their limits, ends in
/// motion.
Status check_timed(const TimedWaypoints & waypoints, const Limits & limits);

/// A first time above 0 is how long the way from `start`, at rest, to the first position may take: puts
/// `start` in front, at 0.
void prepend_start(TimedWaypoints & waypoints, const Joints & start);

/// The trajectory that is at each position at its time, or the reason why it cannot be: a limit that it would
/// exceed (the first one, with joint, time, waypoint, value and limit), or bad input. Times are never
/// changed.
///
/// Positions alone: the cubic spline with continuous accelerations, at rest at both ends; its first and last
/// interval are quintic, so that the acceleration begins and ends at zero. With velocities: through these
/// velocities, with accelerations estimated from both neighbours: quintic, continuous acceleration. With
/// accelerations as well: the quintic through all of them.
Expected<Trajectory> plan_timed(const TimedWaypoints & waypoints, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
