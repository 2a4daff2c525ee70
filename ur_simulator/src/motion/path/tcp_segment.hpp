#pragma once

#include <cstdint>
#include <optional>

#include "common/types.hpp"

namespace ur_simulator {

/// Orientation of the tool on a circle: the argument `mode` of movec.
enum class CircleMode : std::uint8_t {
  unconstrained = 0,  ///< interpolated from the start to the target
  fixed = 1,          ///< constant relative to the tangent
};

/// A path of the TCP: a circular arc followed by a straight line; either may be missing. Distance along it is
/// the path length of the TCP, m, or its rotation angle times `rotation_radius` where that is longer.
class TcpSegment {
 public:
  static constexpr double rotation_radius = 0.3;  ///< m

  TcpSegment() = default;
  static TcpSegment line(const Transform & start, const Transform & target);
  /// The arc from the start through `via` to the target; nothing if the three points are collinear.
  static std::optional<TcpSegment> circle(const Transform & start, const Vector3 & via,
                                          const Transform & target, CircleMode mode);
  /// The arc that leaves the start in `direction`; nothing if its angle would exceed `max_angle` rad.
  static std::optional<TcpSegment> tangent_circle(const Transform & start, const Vector3 & direction,
                                                  const Transform & target, double max_angle);
  /// Leaves the line `incoming` at `distance` and joins the line `outgoing`, which begins where `incoming`
  /// ends, by the arc that is tangent to both. Nothing if there is no such arc of at least `min_radius`.
  static std::optional<TcpSegment> corner(const TcpSegment & incoming, double distance,
                                          const TcpSegment & outgoing, double min_radius);

  Transform at(double distance) const;
  /// The middle of the arc between the point nearest to `position` and the end of the arc; nothing if hardly
  /// any arc remains.
  std::optional<Vector3> middle_of_remaining_arc(const Vector3 & position) const;
  Transform start() const { return start_; }
  Transform target() const { return target_; }
  double length() const { return length_; }
  /// Path length of the TCP, m.
  double tcp_path_length() const;
  /// Radius of the arc, m; 0 if there is no arc.
  double radius() const { return radius_; }

 private:
  /// Direction at the end if the segment ends in a line and distance there is the path length of the TCP.
  std::optional<Vector3> end_direction() const;
  Vector3 point_at(double distance) const;
  Eigen::Matrix3d rotation_at(double distance) const;

  Transform start_ = Transform::Identity();
  Transform target_ = Transform::Identity();
  double length_ = 0.0;
  // Arc.
  Vector3 center_ = Vector3::Zero();
  Vector3 axis_ = Vector3::UnitZ();
  double radius_ = 0.0;
  double angle_ = 0.0;
  double arc_length_ = 0.0;  ///< in units of distance
  // Line after the arc.
  Vector3 line_start_ = Vector3::Zero();
  Vector3 line_direction_ = Vector3::Zero();  ///< m per unit of distance
  // Rotation. A corner completes the rotation of the incoming line while its own begins.
  bool fixed_to_tangent_ = false;
  double corner_tangent_ = 0.0;  ///< m from either end of a corner's arc to the intersection of the lines
  Vector3 incoming_rotation_ = Vector3::Zero();
  Vector3 rotation_ = Vector3::Zero();
  double rotation_per_distance_ = 0.0;  ///< share of rotation_ per unit of distance, where it is constant
};

}  // namespace ur_simulator
