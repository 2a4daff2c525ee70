#pragma once

namespace ur_ros_rtde {

/// Default limits of a motion whose goal does not specify its speed: the defaults of movej and movel
/// (Universal Robots, "Script Manual").
inline constexpr double default_joint_speed = 1.05;         ///< rad/s
inline constexpr double default_joint_acceleration = 1.4;   ///< rad/s^2
inline constexpr double default_linear_speed = 0.25;        ///< m/s
inline constexpr double default_linear_acceleration = 1.2;  ///< m/s^2
/// Limits for the orientation of the TCP. UR's functions have no parameter for it; the limits of a joint are
/// used.
inline constexpr double default_angular_speed = default_joint_speed;                ///< rad/s
inline constexpr double default_angular_acceleration = default_joint_acceleration;  ///< rad/s^2

}  // namespace ur_ros_rtde
