#pragma once

#include <Eigen/Geometry>
#include <array>
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

/// One Denavit-Hartenberg row: Rz(q + theta) Tz(d) Tx(a) Rx(alpha), in m and rad.
struct DhRow {
  double theta, a, d, alpha;
};

/// Calibrated kinematics: the rows of the six joints, as the controller of an arm reports them.
using DhRows = std::array<DhRow, 6>;

/// Nominal Denavit-Hartenberg parameters in m. The parameters not listed are 0, except alpha: pi/2, 0, 0,
/// pi/2, -pi/2, 0. Values are published by Universal Robots ("Parameters for calculations of kinematics and
/// dynamics", and the configuration files of the ROS description).
struct DhParameters {
  double d1, a2, a3, d4, d5, d6;
};

/// The rows of nominal parameters.
DhRows dh_rows(const DhParameters & dh);

/// Kinematics of a UR arm with a tool. The calibration of a real arm deviates from the nominal parameters of
/// its model by some tenths of a millimeter up to millimeters.
class Arm {
 public:
  explicit Arm(const DhRows & rows, const Pose & tool = Pose::Identity()) : rows_(rows), tool_(tool) {}
  explicit Arm(const DhParameters & dh, const Pose & tool = Pose::Identity()) : Arm(dh_rows(dh), tool) {}

  /// Pose of the TCP in the base frame.
  Pose forward(const Joints & q) const;
  /// Geometric Jacobian of the TCP in the base frame: linear part first.
  Jacobian jacobian(const Joints & q) const;
  /// Joint positions near `guess` that place the TCP at `pose`, by Newton's method. Returns nullopt if the
  /// iteration does not converge.
  std::optional<Joints> inverse(const Pose & pose, const Joints & guess) const;

 private:
  DhRows rows_;
  Pose tool_;
};

/// Nominal DH parameters of all models, as published by Universal Robots.
const std::vector<DhParameters> & nominal_dh_parameters();

/// Selects the kinematics that best match the TCP pose `tcp` that the controller reports for joint positions
/// `q` and tool `tool`: the calibration of the arm, if it is known, or the nominal kinematics of a model.
/// Returns an error if the best match deviates by more than 15 mm or 0.03 rad.
Expected<Arm> identify_arm(const Joints & q, const Pose & tcp, const Pose & tool,
                           const std::optional<DhRows> & calibration = std::nullopt);

/// Displacement from `from` to `to`: translation in m and rotation vector in rad, in the base frame.
Twist difference(const Pose & from, const Pose & to);
/// `pose` displaced by `by`, which is given in the base frame.
Pose moved(const Pose & pose, const Twist & by);

/// Conversion from and to UR poses: position and rotation vector.
Pose to_pose(const Vector6 & pose);
Vector6 to_ur(const Pose & pose);

}  // namespace ur_ros_rtde::kinematics
