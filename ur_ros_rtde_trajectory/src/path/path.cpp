#include "path/path.hpp"

#include <algorithm>

namespace ur_ros_rtde::trajectory {

PathPoint PathPiece::at(double u) const
{
  if (length <= 0.0) {
    return {c[0], Joints::Zero(), Joints::Zero(), Joints::Zero()};
  }
  const double x = u / length;
  const double scale = 1.0 / length;
  if (is_line()) {
    return {c[0] + c[1] * x, c[1] * scale, Joints::Zero(), Joints::Zero()};
  }
  // Horner's scheme for a polynomial and its first three derivatives, divided by 1, 1, 2 and 6.
  Joints p = c[static_cast<std::size_t>(degree)];
  Joints p1 = Joints::Zero();
  Joints p2 = Joints::Zero();
  Joints p3 = Joints::Zero();
  for (int k = degree - 1; k >= 0; --k) {
    p3 = p3 * x + p2;
    p2 = p2 * x + p1;
    p1 = p1 * x + p;
    p = p * x + c[static_cast<std::size_t>(k)];
  }
  return {p, p1 * scale, p2 * (2.0 * scale * scale), p3 * (6.0 * scale * scale * scale)};
}

PathPiece cubic_piece(const Joints & from, const Joints & to, const Joints & from_slope,
                      const Joints & to_slope, double length)
{
  PathPiece piece;
  piece.length = length;
  piece.degree = 3;
  const Joints rise = to - from;
  const Joints m0 = from_slope * length;
  const Joints m1 = to_slope * length;
  piece.c[0] = from;
  piece.c[1] = m0;
  piece.c[2] = 3.0 * rise - 2.0 * m0 - m1;
  piece.c[3] = m0 + m1 - 2.0 * rise;
  return piece;
}

std::size_t Path::piece_at(double s) const
{
  const auto after =
      std::upper_bound(pieces.begin(), pieces.end(), s,
                       [](double value, const PathPiece & piece) { return value < piece.start; });
  return after == pieces.begin() ? 0 : static_cast<std::size_t>(after - pieces.begin()) - 1;
}

std::vector<std::pair<std::size_t, std::size_t>> Path::segments() const
{
  std::vector<std::pair<std::size_t, std::size_t>> result;
  std::size_t first = 0;
  for (const std::size_t stop : stops) {
    result.emplace_back(first, stop);
    first = stop;
  }
  if (first < pieces.size()) {
    result.emplace_back(first, pieces.size());
  }
  return result;
}

}  // namespace ur_ros_rtde::trajectory
