#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"
#include "ur_ros_rtde_trajectory/limits.hpp"
#include "ur_ros_rtde_trajectory/vector.hpp"

namespace ur_ros_rtde::kinematics {

using trajectory::Joints;
using Pose = Eigen::Isometry3d;
using Twist = Eigen::Matrix<double, 6, 1>;  ///< m/s and rad/s, or small displacements in m and rad
using Jacobian = Eigen::Matrix<double, 6, 6>;

/// m; Denavit-Hartenberg parameters, all others of a UR arm are 0 but alpha, which is pi/2, 0, 0, pi/2,
/// -pi/2, 0. As published by Universal Robots ("Parameters for calculations of kinematics and dynamics", and
/// the configurations of its ROS description).
struct DhParameters {
  double d1, a2, a3, d4, d5, d6;
};

/// A UR arm with a tool. Every arm leaves its calibration's few tenths of a millimetre to millimetres beside
/// the published lengths: `correction` takes them away where they are known.
class Arm {
 public:
  explicit Arm(const DhParameters & dh, const Pose & tool = Pose::Identity()) : dh_(dh), tool_(tool) {}

  /// Of the TCP, in the robot's base frame.
  Pose forward(const Joints & q) const;
  /// The TCP's velocity by the joints', in the base frame.
  Jacobian jacobian(const Joints & q) const;
  /// The joint positions near `guess` that put the TCP to `pose`: Newton's method. None when it does not get
  /// there.
  std::optional<Joints> inverse(const Pose & pose, const Joints & guess) const;

 private:
  DhParameters dh_;
  Pose tool_;
};

/// The published lengths of all models.
const std::vector<DhParameters> & nominal_dh_parameters();

/// The arm whose published lengths explain best that the controller has the TCP at `tcp` with joints `q` and
/// tool `tool`. Refused when even those are 15 mm or 0.03 rad beside it.
Expected<Arm> identify_arm(const Joints & q, const Pose & tcp, const Pose & tool);

/// By which a pose must be moved to become another one: m and rad, in the base frame.
Twist difference(const Pose & from, const Pose & to);
Pose moved(const Pose & pose, const Twist & by);

/// UR's notation: position and rotation vector.
Pose to_pose(const Vector6 & pose);
Vector6 to_ur(const Pose & pose);

}  // namespace ur_ros_rtde::kinematics
