#pragma once

namespace ur_ros_rtde::trajectory {

/// Ranges of the fields of goals with waypoints, of execute_trajectory and the like. The velocities of a goal
/// are limited by those of the arm.
inline constexpr double max_goal_acceleration = 40.0;    ///< rad/s^2
inline constexpr double max_goal_jerk = 1e7;             ///< rad/s^3
inline constexpr double min_goal_speed_fraction = 0.01;  ///< at most 1
inline constexpr double max_goal_blend_tolerance = 1.0;  ///< rad

}  // namespace ur_ros_rtde::trajectory
