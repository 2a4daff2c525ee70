#include "motion/tcp_leg.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/pose.hpp"

namespace ur_simulator {
namespace {

constexpr double no_way = 1e-12;
// Three points nearer to a line than by this angle make no circle that could be told from it.
constexpr double least_bend = 1e-4;  // rad

/// The cubic that goes from 0 to `end` with these slopes while u goes from 0 to 1.
double hermite(double u, double end, double slope_at_start, double slope_at_end)
{
  const double u2 = u * u, u3 = u2 * u;
  return end * (3.0 * u2 - 2.0 * u3) + slope_at_start * (u3 - 2.0 * u2 + u) + slope_at_end * (u3 - u2);
}

Vector3 turn_between(const Transform & from, const Transform & to)
{
  return to_rotation_vector(from.linear().transpose() * to.linear());
}

}  // namespace

TcpLeg TcpLeg::line(const Transform & start, const Transform & target)
{
  TcpLeg leg;
  leg.start_ = start;
  leg.target_ = target;
  leg.turn_ = turn_between(start, target);
  leg.line_start_ = start.translation();
  const Vector3 way = target.translation() - start.translation();
  leg.length_ = std::max(way.norm(), turning_radius * leg.turn_.norm());
  if (leg.length_ < no_way) {
    leg.length_ = 0.0;
    return leg;
  }
  leg.along_ = way / leg.length_;
  leg.turn_per_distance_ = 1.0 / leg.length_;
  return leg;
}

std::optional<TcpLeg> TcpLeg::circle(const Transform & start, const Vector3 & via, const Transform & target,
                                     CircleMode mode)
{
  const Vector3 to_via = via - start.translation();
  const Vector3 to_target = target.translation() - start.translation();
  const Vector3 normal = to_via.cross(to_target);
  const double size = to_via.norm() * (to_target - to_via).norm();
  if (!(normal.norm() > least_bend * size) || to_target.norm() < 1e-6 || size < 1e-12) {
    return std::nullopt;
  }
  TcpLeg leg;
  leg.start_ = start;
  leg.target_ = target;
  // Centre of the circle through three points, seen from the first.
  const Vector3 to_centre =
      (to_via.squaredNorm() * to_target.cross(normal) + to_target.squaredNorm() * normal.cross(to_via)) /
      (2.0 * normal.squaredNorm());
  leg.centre_ = start.translation() + to_centre;
  leg.axis_ = normal.normalized();
  leg.radius_ = to_centre.norm();
  const Vector3 spoke = -to_centre, last_spoke = to_target - to_centre;
  const double angle = std::atan2(leg.axis_.dot(spoke.cross(last_spoke)), spoke.dot(last_spoke));
  leg.angle_ = angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
  leg.length_ = leg.radius_ * leg.angle_;
  leg.fixed_to_tangent_ = mode == CircleMode::fixed;
  if (leg.fixed_to_tangent_) {
    leg.target_.linear() = Eigen::AngleAxisd(leg.angle_, leg.axis_) * start.linear();
  } else {
    leg.turn_ = turn_between(start, target);
    leg.length_ = std::max(leg.length_, turning_radius * leg.turn_.norm());
  }
  leg.arc_length_ = leg.length_;
  leg.turn_per_distance_ = 1.0 / leg.length_;
  return leg;
}

std::optional<TcpLeg> TcpLeg::tangent_circle(const Transform & start, const Vector3 & direction,
                                             const Transform & target, double most)
{
  const Vector3 chord = target.translation() - start.translation();
  const Vector3 normal = direction.cross(chord);
  // Between tangent and chord lies half the angle of the arc.
  const double half = std::atan2(normal.norm(), direction.dot(chord));
  if (chord.norm() < 1e-6 || half > 0.5 * most) {
    return std::nullopt;
  }
  if (half < least_bend) {
    return line(start, target);
  }
  const Vector3 inwards = normal.cross(direction).normalized();
  const double radius = 0.5 * chord.norm() / std::sin(half);
  const Vector3 centre = start.translation() + radius * inwards;
  const Eigen::AngleAxisd halfway(half, normal.normalized());
  const Vector3 via = centre + halfway * (start.translation() - centre);
  return circle(start, via, target, CircleMode::unconstrained);
}

std::optional<Vector3> TcpLeg::straight_end() const
{
  const bool even = std::abs(along_.norm() - 1.0) < 1e-9;
  return even && length_ > 0.0 ? std::optional<Vector3>(along_) : std::nullopt;
}

std::optional<TcpLeg> TcpLeg::corner(const TcpLeg & in, double distance, const TcpLeg & out,
                                     double least_radius)
{
  const auto before = in.straight_end(), after = out.straight_end();
  const double tangent = in.length_ - distance;
  if (!before || !after || out.arc_length_ > 0.0 || distance < in.arc_length_ || tangent < 1e-6 ||
      out.length_ < tangent) {
    return std::nullopt;
  }
  TcpLeg leg;
  leg.start_ = in.at(distance);
  leg.target_ = out.target_;
  leg.corner_tangent_ = tangent;
  const Vector3 normal = before->cross(*after);
  leg.angle_ = std::atan2(normal.norm(), before->dot(*after));
  if (leg.angle_ > least_bend) {
    leg.radius_ = tangent / std::tan(0.5 * leg.angle_);
    leg.axis_ = normal.normalized();
    leg.centre_ = leg.start_.translation() + leg.radius_ * leg.axis_.cross(*before);
    leg.arc_length_ = leg.radius_ * leg.angle_;
    leg.length_ = leg.arc_length_ + out.length_ - tangent;
    leg.line_start_ = out.start_.translation() + tangent * *after;
    leg.along_ = *after;
    if (leg.radius_ < least_radius) {
      return std::nullopt;
    }
  } else {
    const Vector3 way = leg.target_.translation() - leg.start_.translation();
    leg.length_ = way.norm();
    leg.arc_length_ = 2.0 * tangent;
    leg.line_start_ = leg.start_.translation();
    leg.along_ = way / leg.length_;
  }
  leg.turn_in_ = turn_between(leg.start_, in.target_);
  leg.turn_ = out.turn_;
  leg.turn_per_distance_ = out.turn_per_distance_;
  return leg;
}

double TcpLeg::tool_way() const
{
  const double straight = radius_ > 0.0 ? length_ - arc_length_ : length_;
  return radius_ * angle_ + straight * along_.norm();
}

Transform TcpLeg::at(double distance) const
{
  Transform pose = Transform::Identity();
  pose.translation() = point_at(distance);
  pose.linear() = rotation_at(distance);
  return pose;
}

std::optional<Vector3> TcpLeg::halfway_on(const Vector3 & here) const
{
  const Vector3 spoke = start_.translation() - centre_, there = here - centre_;
  const double turned = std::atan2(axis_.dot(spoke.cross(there)), spoke.dot(there));
  // What lies behind the end belongs to the start, from which a stop may lead back a little.
  const double passed = turned < 0.0 && turned + 2.0 * std::numbers::pi < angle_
                            ? turned + 2.0 * std::numbers::pi
                            : std::max(0.0, turned);
  if (radius_ <= 0.0 || angle_ - passed < 0.01) {
    return std::nullopt;
  }
  return centre_ + Eigen::AngleAxisd(0.5 * (passed + angle_), axis_) * spoke;
}

Vector3 TcpLeg::point_at(double distance) const
{
  if (radius_ <= 0.0) {
    return line_start_ + distance * along_;
  }
  if (distance > arc_length_) {
    return line_start_ + (distance - arc_length_) * along_;
  }
  const Eigen::AngleAxisd turned(angle_ * distance / arc_length_, axis_);
  return centre_ + turned * (start_.translation() - centre_);
}

Eigen::Matrix3d TcpLeg::rotation_at(double distance) const
{
  if (fixed_to_tangent_) {
    return Eigen::AngleAxisd(angle_ * distance / length_, axis_) * start_.linear();
  }
  if (corner_tangent_ <= 0.0) {
    return start_.linear() * to_rotation(distance * turn_per_distance_ * turn_);
  }
  // Through a corner the one turning ends as the other begins, both without a leap in their rates.
  const double u = std::min(1.0, distance / arc_length_);
  const double share = corner_tangent_ * turn_per_distance_;
  const double old = hermite(u, 1.0, arc_length_ / corner_tangent_, 0.0);
  const double beyond = std::max(0.0, distance - arc_length_) * turn_per_distance_;
  const double own = hermite(u, share, 0.0, arc_length_ * turn_per_distance_) + beyond;
  return start_.linear() * to_rotation(old * turn_in_) * to_rotation(own * turn_);
}

}  // namespace ur_simulator
