#include "ur_ros_rtde_trajectory/arm.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinematics/displacement_norm.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

Pose link_pose(const DhRow & row, double q)
{
  Pose pose = Pose::Identity();
  pose.rotate(AngleAxisd(q + row.theta, Vector3d::UnitZ()));
  pose.translate(Vector3d(row.a, 0.0, row.d));
  pose.rotate(AngleAxisd(row.alpha, Vector3d::UnitX()));
  return pose;
}

Vector3d rotation_vector(const Eigen::Matrix3d & rotation)
{
  const AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

}  // namespace

DhRows dh_rows(const DhParameters & l)
{
  return {DhRow{0.0, 0.0, l.d1, pi / 2.0}, DhRow{0.0, l.a2, 0.0, 0.0},       DhRow{0.0, l.a3, 0.0, 0.0},
          DhRow{0.0, 0.0, l.d4, pi / 2.0}, DhRow{0.0, 0.0, l.d5, -pi / 2.0}, DhRow{0.0, 0.0, l.d6, 0.0}};
}

Pose Arm::forward(const Joints & q) const
{
  Pose pose = Pose::Identity();
  for (int j = 0; j < trajectory::joint_count; ++j) {
    pose = pose * link_pose(rows_[static_cast<std::size_t>(j)], q[j]);
  }
  return pose * tool_;
}

Jacobian Arm::jacobian(const Joints & q) const
{
  const Vector3d tcp = forward(q).translation();
  Jacobian result;
  Pose pose = Pose::Identity();
  for (int j = 0; j < trajectory::joint_count; ++j) {
    const Vector3d axis = pose.linear().col(2);
    result.block<3, 1>(0, j) = axis.cross(tcp - pose.translation());
    result.block<3, 1>(3, j) = axis;
    pose = pose * link_pose(rows_[static_cast<std::size_t>(j)], q[j]);
  }
  return result;
}

std::optional<Joints> Arm::inverse(const Pose & pose, const Joints & guess) const
{
  constexpr int max_iterations = 30;
  constexpr double tolerance = 1e-10;  // m
  constexpr double max_step = 0.3;     // rad; limits the Newton step
  Joints q = guess;
  for (int round = 0; round < max_iterations; ++round) {
    const Twist error = difference(forward(q), pose);
    if (displacement_norm(error) < tolerance) {
      return q;
    }
    Joints step = jacobian(q).partialPivLu().solve(error).array();
    const double longest = step.abs().maxCoeff();
    if (!std::isfinite(longest)) {
      return std::nullopt;
    }
    q += longest > max_step ? Joints(step * (max_step / longest)) : step;
  }
  return std::nullopt;
}

const std::vector<DhParameters> & nominal_dh_parameters()
{
  static const std::vector<DhParameters> table{
      {0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819},  // UR3
      {0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823},  // UR5
      {0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922},     // UR10
      {0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921},  // UR3e
      {0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996},       // UR5e, UR7e
      {0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655},  // UR10e, UR12e
      {0.1807, -0.4784, -0.36, 0.17415, 0.11985, 0.11655},     // UR16e
      {0.2186, -0.8989, -0.7149, 0.1824, 0.1361, 0.1434},      // UR8 Long
      {0.2186, -0.6475, -0.5164, 0.1824, 0.1361, 0.1434},      // UR15
      {0.2186, -0.475, -0.3389, 0.1824, 0.1361, 0.1434},       // UR18
      {0.2363, -0.862, -0.7287, 0.201, 0.1593, 0.1543},        // UR20
      {0.2363, -0.637, -0.5037, 0.201, 0.1593, 0.1543},        // UR30
  };
  return table;
}

Expected<Arm> identify_arm(const Joints & q, const Pose & tcp, const Pose & tool,
                           const std::optional<DhRows> & calibration)
{
  constexpr double max_distance = 0.015;  // m
  constexpr double max_angle = 0.03;      // rad
  std::optional<Arm> best;
  Twist best_error = Twist::Constant(std::numeric_limits<double>::infinity());
  std::vector<DhRows> candidates;
  if (calibration) {
    candidates.push_back(*calibration);
  }
  for (const DhParameters & dh : nominal_dh_parameters()) {
    candidates.push_back(dh_rows(dh));
  }
  for (const DhRows & rows : candidates) {
    const Arm arm(rows, tool);
    const Twist error = difference(arm.forward(q), tcp);
    if (!best || displacement_norm(error) < displacement_norm(best_error)) {
      best = arm;
      best_error = error;
    }
  }
  if (best_error.head<3>().norm() > max_distance || best_error.tail<3>().norm() > max_angle) {
    return failure(
        ErrorCode::not_supported,
        fmt::format(
            "no known model matches the TCP pose of the controller: the nearest one deviates by {:.1f} mm "
            "and {:.3f} rad",
            1e3 * best_error.head<3>().norm(), best_error.tail<3>().norm()));
  }
  return *best;
}

Twist difference(const Pose & from, const Pose & to)
{
  Twist result;
  result.head<3>() = to.translation() - from.translation();
  result.tail<3>() = rotation_vector(to.linear() * from.linear().transpose());
  return result;
}

Pose moved(const Pose & pose, const Twist & by)
{
  const Vector3d rotation = by.tail<3>();
  const double angle = rotation.norm();
  Pose result = pose;
  result.translation() += by.head<3>();
  if (angle > 0.0) {
    result.linear() = AngleAxisd(angle, rotation / angle).toRotationMatrix() * pose.linear();
  }
  return result;
}

Pose to_pose(const Vector6 & pose)
{
  return moved(Pose::Identity(), Eigen::Map<const Twist>(pose.data()));
}

Vector6 to_ur(const Pose & pose)
{
  Vector6 result;
  Eigen::Map<Twist>(result.data()) = difference(Pose::Identity(), pose);
  return result;
}

}  // namespace ur_ros_rtde::kinematics
