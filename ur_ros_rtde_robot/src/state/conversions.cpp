#include "ur_ros_rtde_robot/state/conversions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ur_ros_rtde {
namespace {

constexpr double shortest_quaternion = 1e-6;

Vector3 cross(const Vector3 & a, const Vector3 & b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Quaternion product(const Quaternion & a, const Quaternion & b)
{
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Vector3 rotate(const Quaternion & q, const Vector3 & v)
{
  const Vector3 axis{q.x, q.y, q.z};
  const Vector3 t = cross(axis, v);
  const Vector3 u = cross(axis, t);
  return {v[0] + 2.0 * (q.w * t[0] + u[0]), v[1] + 2.0 * (q.w * t[1] + u[1]),
          v[2] + 2.0 * (q.w * t[2] + u[2])};
}

Quaternion conjugate(const Quaternion & q)
{
  return {-q.x, -q.y, -q.z, q.w};
}

/// Converts a unit quaternion. The angle is computed with atan2, which is accurate over the whole range:
/// acos(w) loses half the digits near angle 0, asin(|v|) near pi.
Vector3 to_rotation_vector(const Quaternion & q)
{
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Vector3 axis{sign * q.x, sign * q.y, sign * q.z};
  const double sine = length(axis);
  // 2 atan(s / c) / s -> 2 as s -> 0
  const double scale = sine < 1e-12 ? 2.0 : 2.0 * std::atan2(sine, sign * q.w) / sine;
  return {scale * axis[0], scale * axis[1], scale * axis[2]};
}

}  // namespace

Expected<Vector3> rotation_vector(const Quaternion & rotation)
{
  const double length = std::hypot(std::hypot(rotation.x, rotation.y), std::hypot(rotation.z, rotation.w));
  if (!std::isfinite(length)) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("orientation is ({}, {}, {}, {}): its components must be finite numbers",
                               rotation.x, rotation.y, rotation.z, rotation.w));
  }
  if (length < shortest_quaternion) {
    return failure(
        ErrorCode::invalid_goal,
        fmt::format("orientation is ({}, {}, {}, {}), which is not a rotation: a quaternion has norm 1; no "
                    "rotation is w = 1",
                    rotation.x, rotation.y, rotation.z, rotation.w));
  }
  return to_rotation_vector(
      {rotation.x / length, rotation.y / length, rotation.z / length, rotation.w / length});
}

Quaternion quaternion(const Vector3 & rotation_vector)
{
  const double angle = length(rotation_vector);
  // sin(a/2)/a -> 1/2 as a -> 0
  const double scale = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  const double w = std::cos(0.5 * angle);
  const double sign = w < 0.0 ? -1.0 : 1.0;
  return {sign * scale * rotation_vector[0], sign * scale * rotation_vector[1],
          sign * scale * rotation_vector[2], sign * w};
}

Vector3 rotate(const Vector3 & rotation_vector, const Vector3 & v)
{
  return rotate(quaternion(rotation_vector), v);
}

Vector3 rotate_back(const Vector3 & rotation_vector, const Vector3 & v)
{
  return rotate(conjugate(quaternion(rotation_vector)), v);
}

Vector6 pose_trans(const Vector6 & a, const Vector6 & b)
{
  const Quaternion rotation_a = quaternion(rotation(a));
  const Vector3 moved = rotate(rotation_a, position(b));
  const Vector3 turned = to_rotation_vector(product(rotation_a, quaternion(rotation(b))));
  return {a[0] + moved[0], a[1] + moved[1], a[2] + moved[2], turned[0], turned[1], turned[2]};
}

Vector6 pose_inverse(const Vector6 & pose)
{
  const Vector3 p = rotate_back(rotation(pose), position(pose));
  return {-p[0], -p[1], -p[2], -pose[3], -pose[4], -pose[5]};
}

Vector6 at_tcp(const Vector6 & wrench_at_flange, const Vector6 & tcp, const Vector6 & tcp_offset)
{
  const Vector6 flange = pose_trans(tcp, pose_inverse(tcp_offset));
  const Vector6 & w = wrench_at_flange;
  const Vector3 lever{tcp[0] - flange[0], tcp[1] - flange[1], tcp[2] - flange[2]};
  return {w[0],
          w[1],
          w[2],
          w[3] - (lever[1] * w[2] - lever[2] * w[1]),
          w[4] - (lever[2] * w[0] - lever[0] * w[2]),
          w[5] - (lever[0] * w[1] - lever[1] * w[0])};
}

Vector6 tcp_frame_force(const Sample & sample)
{
  const auto & wrench = sample.actual_tcp_force;
  const Vector3 orientation = rotation(sample.actual_tcp_pose);
  const Vector3 force = rotate_back(orientation, {wrench[0], wrench[1], wrench[2]});
  const Vector3 torque = rotate_back(orientation, {wrench[3], wrench[4], wrench[5]});
  return {force[0], force[1], force[2], torque[0], torque[1], torque[2]};
}

}  // namespace ur_ros_rtde
