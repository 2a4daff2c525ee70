#include "common/pose.hpp"

#include <cmath>

namespace ur_simulator {

Eigen::Matrix3d to_rotation_matrix(const Vector3 & rotation_vector)
{
  const double angle = rotation_vector.norm();
  if (angle < 1e-300) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Vector3 to_rotation_vector(const Eigen::Matrix3d & rotation)
{
  // Via the quaternion: the angle computed from the trace is inaccurate near 0 and pi.
  const Eigen::Quaterniond quaternion = Eigen::Quaterniond(rotation).normalized();
  const double sign = quaternion.w() < 0.0 ? -1.0 : 1.0;
  const Vector3 vector = sign * quaternion.vec();
  const double length = vector.norm();
  if (length < 1e-12) {
    return 2.0 * vector;
  }
  return 2.0 * std::atan2(length, sign * quaternion.w()) / length * vector;
}

Transform to_transform(const Vector6 & pose)
{
  Transform transform = Transform::Identity();
  transform.linear() = to_rotation_matrix(pose.tail<3>());
  transform.translation() = pose.head<3>();
  return transform;
}

Vector6 to_pose(const Transform & transform)
{
  Vector6 pose;
  pose << transform.translation(), to_rotation_vector(transform.linear());
  return pose;
}

Vector6 pose_trans(const Vector6 & a, const Vector6 & b)
{
  return to_pose(to_transform(a) * to_transform(b));
}

Vector6 pose_inv(const Vector6 & pose)
{
  return to_pose(to_transform(pose).inverse());
}

Vector6 interpolate_pose(const Vector6 & from, const Vector6 & to, double alpha)
{
  const Eigen::Matrix3d start = to_rotation_matrix(from.tail<3>());
  const Vector3 turn = to_rotation_vector(start.transpose() * to_rotation_matrix(to.tail<3>()));
  Vector6 pose;
  pose << from.head<3>() + alpha * (to.head<3>() - from.head<3>()),
      to_rotation_vector(start * to_rotation_matrix(alpha * turn));
  return pose;
}

Vector6 shift_wrench(const Vector6 & wrench, const Vector3 & lever)
{
  Vector6 shifted = wrench;
  shifted.tail<3>() += lever.cross(Vector3(wrench.head<3>()));
  return shifted;
}

Vector6 rotate_spatial_vector(const Eigen::Matrix3d & rotation, const Vector6 & pair)
{
  Vector6 rotated;
  rotated << rotation * pair.head<3>(), rotation * pair.tail<3>();
  return rotated;
}

}  // namespace ur_simulator
