#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// Point of a path and its derivatives with respect to the path parameter s.
struct PathPoint {
  Joints q, d1, d2, d3;
};

/// Polynomial in x = u / length, 0 <= x <= 1. Positions on the piece are given by u = s - start, so that
/// their accuracy does not depend on the length of the whole path.
struct PathPiece {
  static constexpr int max_degree = 7;

  double start = 0.0;
  double length = 0.0;
  double max_speed = unlimited;  ///< maximum ds/dt, in addition to the limits of the joints
  int degree = 1;
  std::array<Joints, max_degree + 1> c;  ///< coefficient of x^k

  PathPiece() { c.fill(Joints::Zero()); }
  double end() const { return start + length; }
  bool is_line() const { return degree == 1; }
  PathPoint at(double u) const;
};

/// Cubic Hermite piece from `from` to `to`, with the given derivatives with respect to s at both ends. Its
/// `start` is not set.
PathPiece cubic_piece(const Joints & from, const Joints & to, const Joints & from_slope,
                      const Joints & to_slope, double length);

/// Curve q(s), 0 <= s <= length(), with approximately unit speed in s. Between two stops it is twice
/// continuously differentiable with a bounded third derivative. At a stop, its direction may be
/// discontinuous.
struct Path {
  std::vector<PathPiece> pieces;
  std::vector<double> waypoints;  ///< s of each of the caller's waypoints, not decreasing
  std::vector<std::size_t>
      stops;  ///< index of the first piece after each stop, increasing; the ends are not listed

  double length() const { return pieces.empty() ? 0.0 : pieces.back().end(); }
  /// Piece that contains s; at a boundary, the later one.
  std::size_t piece_at(double s) const;
  /// Half-open ranges of pieces between two stops.
  std::vector<std::pair<std::size_t, std::size_t>> segments() const;
};

}  // namespace ur_ros_rtde::trajectory
