#include "motion/path/tcp_segment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

constexpr double min_length = 1e-12;
// Points that deviate less than this angle from a line are collinear.
constexpr double min_angle = 1e-4;  // rad

/// Cubic Hermite interpolation from 0 (u = 0) to `end` (u = 1) with these slopes.
double hermite(double u, double end, double slope_at_start, double slope_at_end)
{
  const double u2 = u * u, u3 = u2 * u;
  return end * (3.0 * u2 - 2.0 * u3) + slope_at_start * (u3 - 2.0 * u2 + u) + slope_at_end * (u3 - u2);
}

Vector3 relative_rotation(const Transform & from, const Transform & to)
{
  return to_rotation_vector(from.linear().transpose() * to.linear());
}

}  // namespace

TcpSegment TcpSegment::line(const Transform & start, const Transform & target)
{
  TcpSegment segment;
  segment.start_ = start;
  segment.target_ = target;
  segment.rotation_ = relative_rotation(start, target);
  segment.line_start_ = start.translation();
  const Vector3 displacement = target.translation() - start.translation();
  segment.length_ = std::max(displacement.norm(), rotation_radius * segment.rotation_.norm());
  if (segment.length_ < min_length) {
    segment.length_ = 0.0;
    return segment;
  }
  segment.line_direction_ = displacement / segment.length_;
  segment.rotation_per_distance_ = 1.0 / segment.length_;
  return segment;
}

std::optional<TcpSegment> TcpSegment::circle(const Transform & start, const Vector3 & via,
                                             const Transform & target, CircleMode mode)
{
  const Vector3 to_via = via - start.translation();
  const Vector3 to_target = target.translation() - start.translation();
  const Vector3 normal = to_via.cross(to_target);
  const double scale = to_via.norm() * (to_target - to_via).norm();
  if (!(normal.norm() > min_angle * scale) || to_target.norm() < 1e-6 || scale < 1e-12) {
    return std::nullopt;
  }
  TcpSegment segment;
  segment.start_ = start;
  segment.target_ = target;
  // From the first point to the center of the circle through the three points.
  const Vector3 to_center =
      (to_via.squaredNorm() * to_target.cross(normal) + to_target.squaredNorm() * normal.cross(to_via)) /
      (2.0 * normal.squaredNorm());
  segment.center_ = start.translation() + to_center;
  segment.axis_ = normal.normalized();
  segment.radius_ = to_center.norm();
  const Vector3 radius_vector = -to_center, end_radius_vector = to_target - to_center;
  const double angle = std::atan2(segment.axis_.dot(radius_vector.cross(end_radius_vector)),
                                  radius_vector.dot(end_radius_vector));
  segment.angle_ = angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
  segment.length_ = segment.radius_ * segment.angle_;
  segment.fixed_to_tangent_ = mode == CircleMode::fixed;
  if (segment.fixed_to_tangent_) {
    segment.target_.linear() = Eigen::AngleAxisd(segment.angle_, segment.axis_) * start.linear();
  } else {
    segment.rotation_ = relative_rotation(start, target);
    segment.length_ = std::max(segment.length_, rotation_radius * segment.rotation_.norm());
  }
  segment.arc_length_ = segment.length_;
  segment.rotation_per_distance_ = 1.0 / segment.length_;
  return segment;
}

std::optional<TcpSegment> TcpSegment::tangent_circle(const Transform & start, const Vector3 & direction,
                                                     const Transform & target, double max_angle)
{
  const Vector3 chord = target.translation() - start.translation();
  const Vector3 normal = direction.cross(chord);
  // The angle between tangent and chord is half the angle of the arc.
  const double half_angle = std::atan2(normal.norm(), direction.dot(chord));
  if (chord.norm() < 1e-6 || half_angle > 0.5 * max_angle) {
    return std::nullopt;
  }
  if (half_angle < min_angle) {
    return line(start, target);
  }
  const Vector3 inwards = normal.cross(direction).normalized();
  const double radius = 0.5 * chord.norm() / std::sin(half_angle);
  const Vector3 center = start.translation() + radius * inwards;
  const Eigen::AngleAxisd halfway(half_angle, normal.normalized());
  const Vector3 via = center + halfway * (start.translation() - center);
  return circle(start, via, target, CircleMode::unconstrained);
}

std::optional<Vector3> TcpSegment::end_direction() const
{
  const bool unit_speed = std::abs(line_direction_.norm() - 1.0) < 1e-9;
  return unit_speed && length_ > 0.0 ? std::optional<Vector3>(line_direction_) : std::nullopt;
}

std::optional<TcpSegment> TcpSegment::corner(const TcpSegment & incoming, double distance,
                                             const TcpSegment & outgoing, double min_radius)
{
  const auto before = incoming.end_direction(), after = outgoing.end_direction();
  const double tangent = incoming.length_ - distance;
  if (!before || !after || outgoing.arc_length_ > 0.0 || distance < incoming.arc_length_ || tangent < 1e-6 ||
      outgoing.length_ < tangent) {
    return std::nullopt;
  }
  TcpSegment segment;
  segment.start_ = incoming.at(distance);
  segment.target_ = outgoing.target_;
  segment.corner_tangent_ = tangent;
  const Vector3 normal = before->cross(*after);
  segment.angle_ = std::atan2(normal.norm(), before->dot(*after));
  if (segment.angle_ > min_angle) {
    segment.radius_ = tangent / std::tan(0.5 * segment.angle_);
    segment.axis_ = normal.normalized();
    segment.center_ = segment.start_.translation() + segment.radius_ * segment.axis_.cross(*before);
    segment.arc_length_ = segment.radius_ * segment.angle_;
    segment.length_ = segment.arc_length_ + outgoing.length_ - tangent;
    segment.line_start_ = outgoing.start_.translation() + tangent * *after;
    segment.line_direction_ = *after;
    if (segment.radius_ < min_radius) {
      return std::nullopt;
    }
  } else {
    const Vector3 displacement = segment.target_.translation() - segment.start_.translation();
    segment.length_ = displacement.norm();
    segment.arc_length_ = 2.0 * tangent;
    segment.line_start_ = segment.start_.translation();
    segment.line_direction_ = displacement / segment.length_;
  }
  segment.incoming_rotation_ = relative_rotation(segment.start_, incoming.target_);
  segment.rotation_ = outgoing.rotation_;
  segment.rotation_per_distance_ = outgoing.rotation_per_distance_;
  return segment;
}

double TcpSegment::tcp_path_length() const
{
  const double straight = radius_ > 0.0 ? length_ - arc_length_ : length_;
  return radius_ * angle_ + straight * line_direction_.norm();
}

Transform TcpSegment::at(double distance) const
{
  Transform pose = Transform::Identity();
  pose.translation() = point_at(distance);
  pose.linear() = rotation_at(distance);
  return pose;
}

std::optional<Vector3> TcpSegment::middle_of_remaining_arc(const Vector3 & position) const
{
  const Vector3 radius_vector = start_.translation() - center_, position_from_center = position - center_;
  const double turned = std::atan2(axis_.dot(radius_vector.cross(position_from_center)),
                                   radius_vector.dot(position_from_center));
  // A position beyond the end counts as before the start: a stop may end slightly before it.
  const double passed = turned < 0.0 && turned + 2.0 * std::numbers::pi < angle_
                            ? turned + 2.0 * std::numbers::pi
                            : std::max(0.0, turned);
  if (radius_ <= 0.0 || angle_ - passed < 0.01) {
    return std::nullopt;
  }
  return center_ + Eigen::AngleAxisd(0.5 * (passed + angle_), axis_) * radius_vector;
}

Vector3 TcpSegment::point_at(double distance) const
{
  if (radius_ <= 0.0) {
    return line_start_ + distance * line_direction_;
  }
  if (distance > arc_length_) {
    return line_start_ + (distance - arc_length_) * line_direction_;
  }
  const Eigen::AngleAxisd turned(angle_ * distance / arc_length_, axis_);
  return center_ + turned * (start_.translation() - center_);
}

Eigen::Matrix3d TcpSegment::rotation_at(double distance) const
{
  if (fixed_to_tangent_) {
    return Eigen::AngleAxisd(angle_ * distance / length_, axis_) * start_.linear();
  }
  if (corner_tangent_ <= 0.0) {
    return start_.linear() * to_rotation_matrix(distance * rotation_per_distance_ * rotation_);
  }
  // In a corner the incoming rotation ends while the outgoing one begins; both rates are continuous.
  const double u = std::min(1.0, distance / arc_length_);
  const double share = corner_tangent_ * rotation_per_distance_;
  const double incoming_share = hermite(u, 1.0, arc_length_ / corner_tangent_, 0.0);
  const double line_rotation = std::max(0.0, distance - arc_length_) * rotation_per_distance_;
  const double own_rotation = hermite(u, share, 0.0, arc_length_ * rotation_per_distance_) + line_rotation;
  return start_.linear() * to_rotation_matrix(incoming_share * incoming_rotation_) *
         to_rotation_matrix(own_rotation * rotation_);
}

}  // namespace ur_simulator
