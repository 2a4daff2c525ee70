#include "motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "path/quintic_hermite.hpp"

namespace ur_ros_rtde::trajectory {

PathState TimingLawPiece::at(double time) const
{
  const double t = time - start;
  return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
          c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))),
          2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5])),
          6 * c[3] + t * (24 * c[4] + t * 60 * c[5])};
}

std::size_t Motion::piece_at(double time) const
{
  const auto after =
      std::upper_bound(timing.begin(), timing.end(), time,
                       [](double value, const TimingLawPiece & piece) { return value < piece.start; });
  return after == timing.begin() ? 0 : static_cast<std::size_t>(after - timing.begin()) - 1;
}

bool Motion::is_finite(std::size_t first) const
{
  const auto begin = timing.begin() + static_cast<std::ptrdiff_t>(first);
  return std::all_of(begin, timing.end(), [](const TimingLawPiece & piece) {
    return std::isfinite(piece.end()) &&
           std::all_of(std::begin(piece.c), std::end(piece.c), [](double c) { return std::isfinite(c); });
  });
}

void Motion::append(const Grid & grid, const Profile & profile, bool constant_acceleration)
{
  timing.reserve(timing.size() + grid.intervals());
  for (std::size_t i = 0; i < grid.intervals(); ++i) {
    const double end_alpha = constant_acceleration ? profile.alpha[i] : profile.alpha[i + 1];
    append(grid.piece[i], profile.time[i], {grid.begin[i], profile.v[i], profile.alpha[i], 0.0},
           {grid.end[i], profile.v[i + 1], end_alpha, 0.0});
  }
}

void Motion::append(std::size_t path_piece, double span, const PathState & from)
{
  timing.push_back({duration(), span, path_piece, {from.u, from.v, from.a / 2.0, from.j / 6.0, 0.0, 0.0}});
}

void Motion::append(std::size_t path_piece, double span, const PathState & from, const PathState & to)
{
  TimingLawPiece piece;
  piece.start = duration();
  piece.duration = span;
  piece.piece = path_piece;
  // Quintic Hermite interpolation in x = t / span.
  // Over a short time, the difference of two positions consists of rounding errors; the speeds are more
  // accurate.
  constexpr double brief = 5e-4;  // s
  const double rise =
      span < brief ? span * (0.5 * (from.v + to.v) + span * (from.a - to.a) / 12.0) : to.u - from.u;
  const double v0 = from.v * span;
  const double v1 = to.v * span;
  const double a0 = from.a * span * span;
  const double a1 = to.a * span * span;
  const auto x = quintic_hermite(from.u, rise, v0, v1, a0, a1);
  double scale = 1.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    piece.c[k] = x[k] * scale;
    scale /= span;
  }
  timing.push_back(piece);
}

void Motion::stretch(double factor, std::size_t first)
{
  double start = first > 0 ? timing[first - 1].end() : 0.0;
  for (std::size_t k = first; k < timing.size(); ++k) {
    TimingLawPiece & piece = timing[k];
    piece.start = start;
    piece.duration *= factor;
    start = piece.end();
    double scale = 1.0;
    for (double & coefficient : piece.c) {
      coefficient *= scale;
      scale /= factor;
    }
  }
}

Point joint_motion(const PathPoint & point, const PathState & path_state)
{
  const double v2 = path_state.v * path_state.v;
  return {point.q, point.d1 * path_state.v, point.d2 * v2 + point.d1 * path_state.a,
          point.d3 * (v2 * path_state.v) + point.d2 * (3.0 * path_state.v * path_state.a) +
              point.d1 * path_state.j};
}

}  // namespace ur_ros_rtde::trajectory
