#pragma once

#include <vector>

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory {

inline constexpr std::size_t max_timed_waypoints = 100000;

/// Waypoints with given times. All lists that are not empty have the same length.
struct TimedWaypoints {
  std::vector<double> times;                    ///< s, 0.1 ms apart or more, from 0 to at most max_duration
  std::vector<std::vector<double>> positions;   ///< rad, six values each; the first is where the arm is
  std::vector<std::vector<double>> velocities;  ///< rad/s; may be empty. At both ends at most 1e-3
  std::vector<std::vector<double>> accelerations;  ///< rad/s^2; may be empty; only together with velocities.
                                                   ///< At both ends, a step from rest within the jerk limit
};

/// Performs the input checks of plan_timed without planning: list lengths, finite numbers, times, position
/// limits, rest at both ends.
Status check_timed(const TimedWaypoints & waypoints, const Limits & limits);

/// Drops waypoints less than 0.1 ms from another one if no joint moves by more than 1e-3 rad in between, but
/// not the first and the last. A planner that samples at a fixed rate and appends the end (MoveIt) sends such
/// pairs. Later errors and waypoint numbers count the rest. Changes nothing if the lengths of the lists do
/// not fit.
void drop_close_waypoints(TimedWaypoints & waypoints);

/// If the first time is above 0, inserts `start`, at rest, as the first waypoint at time 0. The first time is
/// then the duration of the motion from `start` to the first given position.
void prepend_start(TimedWaypoints & waypoints, const Joints & start);

/// Interpolates a trajectory that passes each position at its given time. Returns an error for invalid input,
/// or for the first limit that would be exceeded (with joint, time, waypoint, value and limit). The given
/// times are never changed.
///
/// Positions only: cubic spline with continuous acceleration, at rest at both ends. The first and last
/// interval are quintic, so that the acceleration starts and ends at zero. Between waypoints more than 0.1 s
/// apart, the intervals next to a position at which a joint is held, turns back or changes its speed much are
/// quintic too: it passes its positions by at most 2 % of their distance. With velocities: quintic with
/// continuous acceleration through the given velocities; accelerations are estimated from both neighboring
/// intervals; between two positions with velocity 0, a joint stays between them. With accelerations: quintic
/// through all given values.
Expected<Trajectory> plan_timed(const TimedWaypoints & waypoints, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
