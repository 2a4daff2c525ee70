#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>

#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde {

/// Kinematics of the arm in a URDF: the transform before the rotation of each joint about its z axis.
using JointOrigins = std::array<Eigen::Isometry3d, 6>;

/// The arm in a URDF, with the joint names of ur_description behind `prefix`. Empty if the text is no URDF,
/// or has no chain of these six joints.
std::optional<JointOrigins> read_description(const std::string & urdf, const std::string & prefix);

struct FlangeDeviation {
  double distance = 0.0;  ///< m
  double angle = 0.0;     ///< rad

  /// Two reports of one calibration agree far better. The repeatability of the arms is 3e-5 m to 1e-4 m.
  bool is_negligible() const { return distance <= 5e-5 && angle <= 5e-5; }
};

/// The largest deviation of the flange at five joint positions, which together show a difference in each
/// length.
FlangeDeviation compare_kinematics(const JointOrigins & description, const kinematics::DhRows & arm);

}  // namespace ur_ros_rtde
