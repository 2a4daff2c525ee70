#pragma once

#include <cmath>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Unit quaternion (x, y, z, w) in the Hamilton convention, as in geometry_msgs.
struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;
};

/// UR's rotation vector (axis times angle, rad) of a quaternion, which need not be normalized; |result| <=
/// pi. Accurate to rounding near 0 and near pi. invalid_goal for NaN, infinity, or a norm below 1e-6.
Expected<Vector3> rotation_vector(const Quaternion & rotation);
/// The unit quaternion with w >= 0 of a rotation vector of any length. NaN yields NaN.
Quaternion quaternion(const Vector3 & rotation_vector);

/// NaN if a coordinate is: the hypot of three numbers of libstdc++ may lose it.
inline double length(double x, double y, double z)
{
  return std::hypot(std::hypot(x, y), z);
}
inline double length(const Vector3 & v)
{
  return length(v[0], v[1], v[2]);
}

/// Position and rotation vector of a UR pose.
inline Vector3 position(const Vector6 & pose)
{
  return {pose[0], pose[1], pose[2]};
}
inline Vector3 rotation(const Vector6 & pose)
{
  return {pose[3], pose[4], pose[5]};
}

/// R v and R^T v, where R is the rotation matrix of the rotation vector.
Vector3 rotate(const Vector3 & rotation_vector, const Vector3 & v);
Vector3 rotate_back(const Vector3 & rotation_vector, const Vector3 & v);

/// T_a T_b: transforms `b` from frame `a` to the parent frame of `a` (URScript's pose_trans).
Vector6 pose_trans(const Vector6 & a, const Vector6 & b);
/// From the parent frame of `pose` to its frame.
Vector6 pose_inverse(const Vector6 & pose);

/// The wrench at the TCP, from that at the flange. Both in the orientation of the frame in which `tcp` is
/// given.
Vector6 at_tcp(const Vector6 & wrench_at_flange, const Vector6 & tcp, const Vector6 & tcp_offset);

/// The wrench Sample::actual_tcp_force in the orientation of the TCP; the reference point stays the TCP. If
/// the rotation of the TCP offset is zero, the robot's default, this is the orientation of the flange frame.
Vector6 tcp_frame_force(const Sample & sample);

}  // namespace ur_ros_rtde
