#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ur_simulator {

/// Six joint values (rad, rad/s, …), a UR pose (x, y, z in m, rotation vector in rad), a twist or a wrench.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector3 = Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Transform = Eigen::Isometry3d;

}  // namespace ur_simulator
