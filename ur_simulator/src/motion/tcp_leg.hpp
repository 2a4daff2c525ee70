#pragma once

#include <cstdint>
#include <optional>

#include "common/types.hpp"

namespace ur_simulator {

/// What the tool's orientation does on a circle, as movec's mode.
enum class CircleMode : std::uint8_t {
  unconstrained = 0,  ///< interpolated from the start's to the target's
  fixed = 1,          ///< constant relative to the tangent
};

/// A way of the TCP: an arc of a circle, then a straight line; either may be missing. Distance along it: the
/// TCP's way in m, or its turning times `turning_radius` where that is longer.
class TcpLeg {
 public:
  static constexpr double turning_radius = 0.3;  ///< m

  TcpLeg() = default;
  static TcpLeg line(const Transform & start, const Transform & target);
  /// The arc from the start through `via` to the target; nothing when the three lie on one line.
  static std::optional<TcpLeg> circle(const Transform & start, const Vector3 & via, const Transform & target,
                                      CircleMode mode);
  /// The arc that leaves the start in `direction`; nothing when it would turn by more than `most` rad.
  static std::optional<TcpLeg> tangent_circle(const Transform & start, const Vector3 & direction,
                                              const Transform & target, double most);
  /// Off the line `in`, from `distance` on, into the line `out` that begins where `in` ends, by the arc that
  /// touches both; nothing when there is none with at least `least_radius`.
  static std::optional<TcpLeg> corner(const TcpLeg & in, double distance, const TcpLeg & out,
                                      double least_radius);

  Transform at(double distance) const;
  /// Halfway along the arc between the point nearest to `here` and its end; nothing when hardly any is left.
  std::optional<Vector3> halfway_on(const Vector3 & here) const;
  Transform start() const { return start_; }
  Transform target() const { return target_; }
  double length() const { return length_; }
  /// The TCP's own way, m.
  double tool_way() const;
  /// Radius of the arc, m; 0 where there is none.
  double radius() const { return radius_; }

 private:
  /// Direction in which it ends, when it ends straight and distance there is the TCP's way.
  std::optional<Vector3> straight_end() const;
  Vector3 point_at(double distance) const;
  Eigen::Matrix3d rotation_at(double distance) const;

  Transform start_ = Transform::Identity();
  Transform target_ = Transform::Identity();
  double length_ = 0.0;
  // The arc.
  Vector3 centre_ = Vector3::Zero();
  Vector3 axis_ = Vector3::UnitZ();
  double radius_ = 0.0;
  double angle_ = 0.0;
  double arc_length_ = 0.0;  ///< in units of distance
  // The line after it.
  Vector3 line_start_ = Vector3::Zero();
  Vector3 along_ = Vector3::Zero();  ///< m per unit of distance
  // The turning: what a corner has left of the line before, and its own.
  bool fixed_to_tangent_ = false;
  double corner_tangent_ = 0.0;  ///< m from either end of a corner's arc to where the lines meet
  Vector3 turn_in_ = Vector3::Zero();
  Vector3 turn_ = Vector3::Zero();
  double turn_per_distance_ = 0.0;  ///< of turn_, where it is even
};

}  // namespace ur_simulator
