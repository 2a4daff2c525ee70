#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// A point of a path and its derivatives by the path parameter s.
struct PathPoint {
  Joints q, d1, d2, d3;
};

/// Polynomials in x = u / length, 0 <= x <= 1. A place on the piece is given by u = s - start, so that its
/// accuracy does not depend on how long the whole path is.
struct PathPiece {
  static constexpr int max_degree = 7;

  double start = 0.0;
  double length = 0.0;
  double max_speed = unlimited;  ///< of s, 1/s, beside what the limits of the joints allow
  int degree = 1;
  std::array<Joints, max_degree + 1> c;  ///< c[k] belongs to x^k

  PathPiece() { c.fill(Joints::Zero()); }
  double end() const { return start + length; }
  bool is_line() const { return degree == 1; }
  PathPoint at(double u) const;
};

/// A curve q(s), 0 <= s <= length(): twice continuously differentiable between two stops, with a bounded
/// third derivative, and of about unit speed in s. At a stop its direction may change at once.
struct Path {
  std::vector<PathPiece> pieces;
  std::vector<double> waypoints;  ///< s of each of the caller's waypoints, not decreasing
  std::vector<std::size_t>
      stops;  ///< index of the first piece after each stop, increasing; the ends are not listed

  double length() const { return pieces.empty() ? 0.0 : pieces.back().end(); }
  /// Piece that contains s; at a border the later one.
  std::size_t piece_at(double s) const;
  /// Half-open ranges of pieces between stops.
  std::vector<std::pair<std::size_t, std::size_t>> segments() const;
};

}  // namespace ur_ros_rtde::trajectory
