#pragma once

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory::test {

/// Largest uses of the limits by finite differences of the sampled *positions*, without what rounding can do
/// to them.
Utilization finite_difference_utilization(const Trajectory & trajectory, const Limits & limits,
                                          double rate = 10000.0);

/// Largest distance of a waypoint from the trajectory at the time of that waypoint, in the joint that
/// deviates most. rad
double max_waypoint_deviation(const Trajectory & trajectory, const std::vector<Joints> & waypoints);

/// Largest speed (rad/s) and acceleration (rad/s^2) just inside both ends.
double motion_at_ends(const Trajectory & trajectory);

}  // namespace ur_ros_rtde::trajectory::test
