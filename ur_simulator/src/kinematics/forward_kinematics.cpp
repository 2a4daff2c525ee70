#include "kinematics/forward_kinematics.hpp"

#include <cmath>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

/// Standard Denavit-Hartenberg: Rz(theta) Tz(d) Tx(a) Rx(alpha).
Transform dh_transform(double theta, double d, double a, double cos_alpha, double sin_alpha)
{
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  Transform transform;
  transform.matrix() << c, -s * cos_alpha, s * sin_alpha, a * c,  //
      s, c * cos_alpha, -c * sin_alpha, a * s,                    //
      0.0, sin_alpha, cos_alpha, d,                               //
      0.0, 0.0, 0.0, 1.0;
  return transform;
}

/// Removes the rounding error of cos and sin at the alpha of UR arms, which are multiples of pi / 2.
double round_near_zero(double cosine_or_sine)
{
  return std::abs(cosine_or_sine) < 1e-12 ? 0.0 : cosine_or_sine;
}

struct Axis {
  Vector3 direction;
  Vector3 origin;
};

/// Axis of joint i (0..5): the z axis of the preceding frame.
Axis joint_axis(const std::array<Transform, 6> & frames, std::size_t i)
{
  if (i == 0) {
    return {Vector3::UnitZ(), Vector3::Zero()};
  }
  return {frames[i - 1].linear().col(2), frames[i - 1].translation()};
}

}  // namespace

std::array<Transform, 6> link_frames(const RobotModel & model, const Vector6 & joints)
{
  std::array<Transform, 6> frames;
  Transform frame = Transform::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    frame = frame * dh_transform(joints[row] + model.theta[row], model.d[row], model.a[row],
                                 round_near_zero(std::cos(model.alpha[row])),
                                 round_near_zero(std::sin(model.alpha[row])));
    frames[i] = frame;
  }
  return frames;
}

Transform flange_pose(const RobotModel & model, const Vector6 & joints)
{
  return link_frames(model, joints)[5];
}

Vector6 tcp_pose(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset)
{
  return to_pose(flange_pose(model, joints) * to_transform(tcp_offset));
}

Matrix6 jacobian(const std::array<Transform, 6> & frames, const Vector3 & tcp_position)
{
  Matrix6 result;
  for (std::size_t i = 0; i < 6; ++i) {
    const Axis axis = joint_axis(frames, i);
    result.col(static_cast<Eigen::Index>(i)) << axis.direction.cross(tcp_position - axis.origin),
        axis.direction;
  }
  return result;
}

Matrix6 jacobian(const RobotModel & model, const Vector6 & joints, const Vector6 & tcp_offset)
{
  const auto frames = link_frames(model, joints);
  return jacobian(frames, frames[5] * tcp_offset.head<3>());
}

Matrix6 jacobian_time_derivative(const RobotModel & model, const Vector6 & joints, const Vector6 & velocity,
                                 const Vector6 & tcp_offset)
{
  const auto frames = link_frames(model, joints);
  const Vector3 tcp = frames[5] * Vector3(tcp_offset.head<3>());
  const Vector3 tcp_velocity = jacobian(frames, tcp).topRows<3>() * velocity;
  Matrix6 result;
  Vector3 angular = Vector3::Zero();          // of the link that carries joint i
  Vector3 origin_velocity = Vector3::Zero();  // of the origin of that link's frame
  for (std::size_t i = 0; i < 6; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Axis axis = joint_axis(frames, i);
    const Vector3 axis_derivative = angular.cross(axis.direction);
    result.col(column) << axis_derivative.cross(tcp - axis.origin) +
                              axis.direction.cross(tcp_velocity - origin_velocity),
        axis_derivative;
    angular += velocity[column] * axis.direction;
    origin_velocity += angular.cross(frames[i].translation() - axis.origin);
  }
  return result;
}

}  // namespace ur_simulator
