#pragma once

#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde::kinematics {

/// Characteristic length that weights rotations against translations, in m/rad: about the distance from the
/// wrist to the TCP.
inline constexpr double characteristic_length = 0.2;

/// Norm of a TCP displacement in m, including rotation.
inline double displacement_norm(const Twist & displacement)
{
  return displacement.head<3>().norm() + characteristic_length * displacement.tail<3>().norm();
}

}  // namespace ur_ros_rtde::kinematics
