#include "motion/grid.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

// Position on the piece, `time` after the start of interval i, at constant acceleration.
double state_after(const Grid & grid, const Profile & profile, std::size_t i, double time)
{
  const double moved = (profile.v[i] + 0.5 * profile.alpha[i] * time) * time;
  return grid.begin[i] + std::clamp(moved, 0.0, grid.width(i));
}

// Adds stations to `fine` for the intervals [begin, end) of `coarse`, which lie on one piece, at equal
// intervals of time.
void resample_piece(const Path & path, const Grid & coarse, const Profile & profile, std::size_t begin,
                    std::size_t end, std::size_t count, Grid & fine)
{
  double total = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    total += profile.time[i];
  }
  const std::size_t piece = coarse.piece[begin];
  const double min_spacing =
      1e-6 * path.pieces[piece].length;  // minimum distance of stations, independent of the times
  double from = coarse.begin[begin];
  const double last = coarse.end[end - 1];
  double elapsed = 0.0;  // start time of interval i
  std::size_t i = begin;
  for (std::size_t k = 1; k < count; ++k) {
    const double time = total * static_cast<double>(k) / static_cast<double>(count);
    while (i + 1 < end && elapsed + profile.time[i] < time) {
      elapsed += profile.time[i++];
    }
    const double to = state_after(coarse, profile, i, time - elapsed);
    if (to - from > min_spacing && last - to > min_spacing) {
      fine.add(path, piece, from, to);
      from = to;
    }
  }
  fine.add(path, piece, from, last);
}

}  // namespace

void Grid::reserve(std::size_t count)
{
  d1.reserve(count + 1);
  d2.reserve(count + 1);
  max_speed.reserve(count + 1);
  piece.reserve(count);
  begin.reserve(count);
  end.reserve(count);
  d3_begin.reserve(count);
  d3_end.reserve(count);
}

void Grid::add(const Path & path, std::size_t piece_index, double from, double to)
{
  const PathPiece & curve = path.pieces[piece_index];
  if (piece.empty()) {
    const PathPoint point = curve.at(from);
    d1.push_back(point.d1);
    d2.push_back(point.d2);
    d3_begin.push_back(point.d3);
    max_speed.push_back(curve.max_speed);
  } else if (piece.back() != piece_index) {
    d3_begin.push_back(curve.at(from).d3);
  } else {
    d3_begin.push_back(d3_end.back());
  }
  const PathPoint point = curve.at(to);
  max_speed.back() = std::min(max_speed.back(), curve.max_speed);
  max_speed.push_back(curve.max_speed);
  d1.push_back(point.d1);
  d2.push_back(point.d2);
  d3_end.push_back(point.d3);
  begin.push_back(from);
  end.push_back(to);
  piece.push_back(static_cast<std::uint32_t>(piece_index));
}

Grid uniform_grid(const Path & path, std::size_t first, std::size_t last, std::size_t count)
{
  Grid grid;
  grid.reserve((last - first) * count);
  for (std::size_t p = first; p < last; ++p) {
    const PathPiece & piece = path.pieces[p];
    double from = 0.0;
    for (std::size_t k = 1; k <= count; ++k) {
      const double to =
          k == count ? piece.length : piece.length * static_cast<double>(k) / static_cast<double>(count);
      grid.add(path, p, from, to);
      from = to;
    }
  }
  return grid;
}

Grid time_spaced_grid(const Path & path, const Grid & coarse, const Profile & profile, double step,
                      std::size_t min_blend_intervals)
{
  Grid fine;
  fine.reserve(coarse.intervals());
  std::size_t begin = 0;
  while (begin < coarse.intervals()) {
    std::size_t end = begin;
    double total = 0.0;
    while (end < coarse.intervals() && coarse.piece[end] == coarse.piece[begin]) {
      total += profile.time[end++];
    }
    const std::size_t floor = path.pieces[coarse.piece[begin]].degree > 3 ? min_blend_intervals : 1;
    const auto wanted = static_cast<std::size_t>(std::ceil(total / step));
    resample_piece(path, coarse, profile, begin, end, std::max(floor, wanted), fine);
    begin = end;
  }
  return fine;
}

}  // namespace ur_ros_rtde::trajectory
