#include "motion/path_offset.hpp"

#include "common/pose.hpp"

namespace ur_simulator {

namespace {

constexpr double min_speed = 1e-6;  // m/s: slower, the path has no direction

/// Translation and rotation from `from` to `to` in base axes.
Vector6 difference(const Transform & from, const Transform & to)
{
  Vector6 result;
  result << to.translation() - from.translation(),
      to_rotation_vector(to.linear() * from.linear().transpose());
  return result;
}

Transform displaced(const Transform & tcp, const Vector6 & in_base_axes)
{
  Transform result = Transform::Identity();
  result.translation() = tcp.translation() + in_base_axes.head<3>();
  result.linear() = to_rotation_matrix(in_base_axes.tail<3>()) * tcp.linear();
  return result;
}

}  // namespace

void PathOffset::enable()
{
  enabled_ = true;
  frame_ = Frame::base;
  motion_axes_.setZero();
  restart();
}

void PathOffset::restart()
{
  requested_.setZero();
  applied_.setZero();
  tcp_ = path_tcp_;
}

void PathOffset::set(const Vector6 & offset, Frame frame)
{
  frame_ = frame;
  requested_ << offset.head<3>().cwiseMin(max_translation_).cwiseMax(-max_translation_),
      offset.tail<3>().cwiseMin(max_rotation_).cwiseMax(-max_rotation_);
}

void PathOffset::set_limits(double translation, double rotation)
{
  max_translation_ = translation;
  max_rotation_ = rotation;
}

Vector6 PathOffset::get(Frame frame) const
{
  switch (frame) {
    case Frame::base:
      return difference(path_tcp_, tcp_);
    case Frame::tcp:
      return to_pose(path_tcp_.inverse() * tcp_);
    case Frame::motion:
      return rotate_spatial_vector(motion_axes_.transpose(), difference(path_tcp_, tcp_));
    case Frame::world:
      return to_pose(path_tcp_ * tcp_.inverse());
  }
  return Vector6::Zero();
}

Transform PathOffset::apply(const Transform & path_tcp, const Vector3 & path_velocity)
{
  update_motion_axes(path_tcp, path_velocity);
  path_tcp_ = path_tcp;
  applied_ = alpha_ * requested_ + (1.0 - alpha_) * applied_;
  tcp_ = offset_pose();
  return tcp_;
}

void PathOffset::update_motion_axes(const Transform & path_tcp, const Vector3 & path_velocity)
{
  const Vector3 x = path_velocity.normalized();
  const Vector3 y = x.cross(path_tcp.linear().col(2));
  // Without a direction, or along the axis of the tool, the axes are kept.
  if (path_velocity.norm() > min_speed && y.norm() > 1e-3) {
    motion_axes_.col(0) = x;
    motion_axes_.col(1) = y.normalized();
    motion_axes_.col(2) = x.cross(motion_axes_.col(1));
  }
}

Transform PathOffset::offset_pose() const
{
  switch (frame_) {
    case Frame::base:
      return displaced(path_tcp_, applied_);
    case Frame::tcp:
      return path_tcp_ * to_transform(applied_);
    case Frame::motion:
      return displaced(path_tcp_, rotate_spatial_vector(motion_axes_, applied_));
    case Frame::world:
      return to_transform(applied_).inverse() * path_tcp_;
  }
  return path_tcp_;
}

}  // namespace ur_simulator
