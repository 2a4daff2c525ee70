#pragma once

#include <array>

namespace ur_ros_rtde {

/// Six joint values in the order base, shoulder, elbow, wrist 1, wrist 2, wrist 3 (rad, rad/s, …); or a UR
/// pose: position (m) and rotation vector (rad); or a twist (m/s, rad/s) or a wrench (N, Nm), linear part
/// first.
using Vector6 = std::array<double, 6>;
using Vector3 = std::array<double, 3>;

}  // namespace ur_ros_rtde
