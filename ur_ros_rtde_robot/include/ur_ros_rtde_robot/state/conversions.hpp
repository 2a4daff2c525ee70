#pragma once

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// A rotation as ROS writes it. (x, y, z, w), Hamilton convention.
struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;
};

/// UR's rotation vector (axis times angle, rad) of a quaternion of any length but (nearly) zero; |result| <=
/// pi. Exact to rounding near 0 and near pi. invalid_goal for NaN, infinity, or a length below 1e-6.
Expected<Vector3> rotation_vector(const Quaternion & rotation);
/// The unit quaternion with w >= 0 of a rotation vector of any length; NaN in, NaN out.
Quaternion quaternion(const Vector3 & rotation_vector);

/// Position and rotation vector of a pose of UR.
inline Vector3 position(const Vector6 & pose)
{
  return {pose[0], pose[1], pose[2]};
}
inline Vector3 rotation(const Vector6 & pose)
{
  return {pose[3], pose[4], pose[5]};
}

/// R v, and R^T v, for the rotation of a rotation vector.
Vector3 rotate(const Vector3 & rotation_vector, const Vector3 & v);
Vector3 rotate_back(const Vector3 & rotation_vector, const Vector3 & v);

/// T_a T_b: `b`, given in the frame `a`, in the frame that `a` is given in (URScript's pose_trans).
Vector6 pose_trans(const Vector6 & a, const Vector6 & b);
Vector6 pose_inverse(const Vector6 & pose);

/// The wrench at the TCP that `sample` gives in the base frame's orientation, in the TCP's orientation. With
/// the TCP offset's rotation at zero, as is the robot's default, that is the flange frame's orientation; the
/// point of action stays the TCP.
Vector6 tcp_frame_force(const Sample & sample);

}  // namespace ur_ros_rtde
