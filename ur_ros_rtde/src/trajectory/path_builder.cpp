#include "trajectory/path_builder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "trajectory/spline.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double same_place = 1e-9;      // rad; closer waypoints are one
constexpr double same_direction = 1e-9;  // change of the unit direction below which a line goes on
constexpr double smallest_radius =
    1e-3;                                // rad; a turn tighter than this is a corner, however small its angle
constexpr double smallest_blend = 1e-5;  // rad; a blend shorter than this gains nothing over a stop

// The waypoints without repetitions, as lines between them.
struct Polyline {
  std::vector<Joints> points;
  std::vector<std::size_t> owner;  // for each of the caller's waypoints, the index in `points`
  std::vector<Joints> direction;   // unit vector of each line
  std::vector<double> length;

  explicit Polyline(const std::vector<Joints> & waypoints)
  {
    for (const Joints & waypoint : waypoints) {
      if (points.empty() || (waypoint - points.back()).abs().maxCoeff() > same_place) {
        points.push_back(waypoint);
      }
      owner.push_back(points.size() - 1);
    }
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Joints step = points[i + 1] - points[i];
      length.push_back(step.matrix().norm());
      direction.push_back(step / length.back());
    }
  }

  Joints turn(std::size_t i) const { return direction[i] - direction[i - 1]; }
  double angle(std::size_t i) const { return 2.0 * std::asin(std::min(1.0, 0.5 * turn(i).matrix().norm())); }
};

class Builder {
 public:
  Builder(const std::vector<Joints> & waypoints, const PathShape & shape) : line_(waypoints), shape_(shape) {}

  Path build()
  {
    place_.assign(line_.points.size(), 0.0);
    if (line_.points.size() > 1) {
      if (shape_.tolerance > 0.0 && !is_straight(0, line_.points.size() - 1)) {
        add_blended_lines();
      } else {
        add_smooth_runs();
      }
      place_.back() = path_.length();
    } else {
      add_straight(line_.points.front(), Joints::Zero(), 0.0);
    }
    for (const std::size_t point : line_.owner) {
      path_.waypoints.push_back(place_[point]);
    }
    return std::move(path_);
  }

 private:
  void add(PathPiece piece)
  {
    piece.start = path_.length();
    path_.pieces.push_back(piece);
  }

  void add_straight(const Joints & from, const Joints & direction, double length)
  {
    PathPiece piece;
    piece.length = length;
    piece.c[0] = from;
    piece.c[1] = direction * length;
    add(piece);
  }

  void stop_here() { path_.stops.push_back(path_.pieces.size()); }

  // --- tolerance 0 ---

  bool is_corner(std::size_t i) const
  {
    const double angle = line_.angle(i);
    if (angle <= same_direction) {
      return false;
    }
    return angle > shape_.corner_angle ||
           std::min(line_.length[i - 1], line_.length[i]) < smallest_radius * angle;
  }

  void add_smooth_runs()
  {
    const std::size_t last = line_.points.size() - 1;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= last; ++i) {
      if (i < last && !is_corner(i)) {
        continue;
      }
      add_run(first, i);
      if (i < last) {
        stop_here();
      }
      first = i;
    }
  }

  // All points from first to last lie on the line between these two.
  bool is_straight(std::size_t first, std::size_t last) const
  {
    const Joints chord = line_.points[last] - line_.points[first];
    const Joints along = chord / chord.matrix().norm();
    for (std::size_t i = first + 1; i < last; ++i) {
      const Joints offset = line_.points[i] - line_.points[first];
      const double forward = (offset * along).sum();
      if ((offset - forward * along).abs().maxCoeff() > same_place || !(forward > 0.0)) {
        return false;
      }
    }
    return true;
  }

  void add_run(std::size_t first, std::size_t last)
  {
    if (is_straight(first, last)) {
      add_straight_run(first, last);
      return;
    }
    const std::span points(line_.points.data() + first, last - first + 1);
    const std::span widths(line_.length.data() + first, last - first);
    const auto slopes = natural_spline_slopes(points, widths);
    for (std::size_t i = first; i < last; ++i) {
      place_[i] = path_.length();
      add_cubic(i, slopes[i - first], slopes[i - first + 1]);
    }
  }

  void add_straight_run(std::size_t first, std::size_t last)
  {
    const double begin = path_.length();
    const Joints chord = line_.points[last] - line_.points[first];
    const double length = chord.matrix().norm();
    for (std::size_t i = first; i < last; ++i) {
      place_[i] = begin + ((line_.points[i] - line_.points[first]) * chord).sum() / length;
    }
    add_straight(line_.points[first], chord / length, length);
  }

  void add_cubic(std::size_t i, const Joints & slope, const Joints & next_slope)
  {
    PathPiece piece;
    piece.length = line_.length[i];
    piece.degree = 3;
    const Joints rise = line_.points[i + 1] - line_.points[i];
    const Joints m0 = slope * piece.length;
    const Joints m1 = next_slope * piece.length;
    piece.c[0] = line_.points[i];
    piece.c[1] = m0;
    piece.c[2] = 3.0 * rise - 2.0 * m0 - m1;
    piece.c[3] = m0 + m1 - 2.0 * rise;
    add(piece);
  }

  // --- tolerance above 0 ---

  // How far before and after point i its blend begins and ends. The direction changes from d0 to d1 along the
  // quintic smoothstep, so the middle of the blend passes the corner at 2 * (5/64) * reach * |d1 - d0|.
  double blend_reach(std::size_t i) const
  {
    constexpr double sag = 2.0 * 5.0 / 64.0;
    const double turn = line_.turn(i).abs().maxCoeff();
    return std::min({shape_.tolerance / (sag * turn), 0.5 * line_.length[i - 1], 0.5 * line_.length[i]});
  }

  void add_blended_lines()
  {
    double cut = 0.0;  // of the current line, used by the blend at its beginning
    for (std::size_t i = 0; i + 1 < line_.points.size(); ++i) {
      const bool has_corner =
          i + 2 < line_.points.size() && line_.turn(i + 1).matrix().norm() > same_direction;
      const double reach = has_corner ? blend_reach(i + 1) : 0.0;
      const bool blended = reach > smallest_blend;
      const double rest = line_.length[i] - cut - (blended ? reach : 0.0);
      if (rest > 1e-12 * line_.length[i]) {
        add_straight(line_.points[i] + line_.direction[i] * cut, line_.direction[i], rest);
      }
      place_[i + 1] = path_.length() + (blended ? reach : 0.0);
      if (blended) {
        add_blend(i + 1, reach);
      } else if (has_corner) {
        stop_here();
      }
      cut = blended ? reach : 0.0;
    }
  }

  // q'(x) = d0 + (d1 - d0) (10 x^3 - 15 x^4 + 6 x^5): three times continuously differentiable where it meets
  // the lines, and inside the triangle of the corner.
  void add_blend(std::size_t i, double reach)
  {
    PathPiece piece;
    piece.length = 2.0 * reach;
    piece.degree = 6;
    const Joints turn = line_.turn(i) * piece.length;
    piece.c[0] = line_.points[i] - line_.direction[i - 1] * reach;
    piece.c[1] = line_.direction[i - 1] * piece.length;
    piece.c[2].setZero();
    piece.c[3].setZero();
    piece.c[4] = 2.5 * turn;
    piece.c[5] = -3.0 * turn;
    piece.c[6] = turn;
    add(piece);
  }

  Polyline line_;
  PathShape shape_;
  Path path_;
  std::vector<double> place_;  // s of each point of the polyline
};

}  // namespace

Path build_path(const std::vector<Joints> & waypoints, const PathShape & shape)
{
  return Builder(waypoints, shape).build();
}

}  // namespace ur_ros_rtde::trajectory
