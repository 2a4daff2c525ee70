#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// Rotation vector (axis times angle, rad) to matrix and back; the vector returned has a length in [0, pi].
Eigen::Matrix3d to_rotation(const Vector3 & rotation_vector);
Vector3 to_rotation_vector(const Eigen::Matrix3d & rotation);

/// UR pose (x, y, z, rx, ry, rz) to transform and back.
Transform to_transform(const Vector6 & pose);
Vector6 to_pose(const Transform & transform);

/// URScript's pose_trans (a * b), pose_inv and interpolate_pose (alpha 0 gives a, 1 gives b; the rotation
/// takes the short way).
Vector6 pose_trans(const Vector6 & a, const Vector6 & b);
Vector6 pose_inv(const Vector6 & pose);
Vector6 interpolate_pose(const Vector6 & from, const Vector6 & to, double alpha);

/// Moves a wrench's point of attack by `lever` (from the new point to the old one), all in one frame's axes.
Vector6 shift_wrench(const Vector6 & wrench, const Vector3 & lever);
/// The same wrench or twist with both its vectors turned into other axes.
Vector6 rotate_pair(const Eigen::Matrix3d & rotation, const Vector6 & pair);

/// True when no element is NaN or infinite.
template <typename Derived>
bool is_finite(const Eigen::DenseBase<Derived> & values)
{
  return values.derived().array().isFinite().all();
}

}  // namespace ur_simulator
