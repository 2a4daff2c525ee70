#pragma once

#include "ur_ros_rtde_trajectory/trajectory.hpp"

namespace ur_ros_rtde::trajectory::test {

constexpr auto no_deadline = std::chrono::steady_clock::time_point::max();

/// Largest utilization of the limits by finite differences of the sampled *positions*, minus the possible
/// rounding errors.
Utilization finite_difference_utilization(const Trajectory & trajectory, const Limits & limits,
                                          double rate = 10000.0);

/// Largest distance in rad of a waypoint from the trajectory at the time of that waypoint, in the joint that
/// deviates most.
double max_waypoint_deviation(const Trajectory & trajectory, const std::vector<Joints> & waypoints);

/// Largest joint speed in rad/s just inside both ends.
double speed_at_ends(const Trajectory & trajectory);

}  // namespace ur_ros_rtde::trajectory::test
