#pragma once

#include "common/types.hpp"

namespace ur_simulator {

/// Converts between a rotation vector (axis times angle, rad) and a rotation matrix. The returned vector has
/// a length in [0, pi].
Eigen::Matrix3d to_rotation_matrix(const Vector3 & rotation_vector);
Vector3 to_rotation_vector(const Eigen::Matrix3d & rotation);

/// Converts between a UR pose (x, y, z, rx, ry, rz; m, rotation vector) and a transform.
Transform to_transform(const Vector6 & pose);
Vector6 to_pose(const Transform & transform);

/// The URScript functions of these names. interpolate_pose: alpha 0 gives `from`, 1 gives `to`; the rotation
/// takes the shortest path.
Vector6 pose_trans(const Vector6 & a, const Vector6 & b);
Vector6 pose_inv(const Vector6 & pose);
Vector6 interpolate_pose(const Vector6 & from, const Vector6 & to, double alpha);

/// Changes the reference point of a wrench. `lever` points from the new reference point to the old one, in
/// the frame of the wrench.
Vector6 shift_wrench(const Vector6 & wrench, const Vector3 & lever);
/// Rotates both vectors of a wrench or twist.
Vector6 rotate_spatial_vector(const Eigen::Matrix3d & rotation, const Vector6 & pair);

/// True if no element is NaN or infinite.
template <typename Derived>
bool is_finite(const Eigen::DenseBase<Derived> & values)
{
  return values.derived().array().isFinite().all();
}

}  // namespace ur_simulator
