#include "path/path_builder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "path/spline.hpp"

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double same_position = 1e-9;    // rad; closer waypoints are merged
constexpr double same_direction = 1e-9;   // smaller changes of the unit direction are ignored
constexpr double smallest_radius = 1e-3;  // rad; a tighter curve is a corner, even if its angle is small
constexpr double smallest_blend = 1e-5;   // rad; a shorter blend has no advantage over a stop

// Polyline through the waypoints, without repetitions.
struct Polyline {
  std::vector<Joints> points;
  std::vector<std::size_t> point_of_waypoint;  // for each of the caller's waypoints, the index in `points`
  std::vector<Joints> direction;               // unit vector of each line
  std::vector<double> length;

  explicit Polyline(const std::vector<Joints> & waypoints)
  {
    for (const Joints & waypoint : waypoints) {
      if (points.empty() || (waypoint - points.back()).abs().maxCoeff() > same_position) {
        points.push_back(waypoint);
      }
      point_of_waypoint.push_back(points.size() - 1);
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
  Builder(const std::vector<Joints> & waypoints, const PathShape & shape)
      : polyline_(waypoints), shape_(shape)
  {
  }

  Path build()
  {
    s_of_point_.assign(polyline_.points.size(), 0.0);
    if (polyline_.points.size() > 1) {
      add_sections();
      blend_corners();
      s_of_point_.back() = path_.length();
    } else {
      add_line(polyline_.points.front(), Joints::Zero(), 0.0);
    }
    for (const std::size_t point : polyline_.point_of_waypoint) {
      path_.waypoints.push_back(s_of_point_[point]);
    }
    return std::move(path_);
  }

 private:
  void add(PathPiece piece)
  {
    piece.start = path_.length();
    path_.pieces.push_back(piece);
  }

  void add_line(const Joints & from, const Joints & direction, double length)
  {
    PathPiece piece;
    piece.length = length;
    piece.c[0] = from;
    piece.c[1] = direction * length;
    add(piece);
  }

  // A corner is a waypoint where the direction changes too much for a smooth curve: a spline through the
  // waypoint would deviate from the straight lines by about an eighth of angle times distance.
  bool is_corner(std::size_t i) const
  {
    const double angle = polyline_.angle(i);
    const double nearer = std::min(polyline_.length[i - 1], polyline_.length[i]);
    const double farther = std::max(polyline_.length[i - 1], polyline_.length[i]);
    if (angle > shape_.corner_angle || nearer < smallest_radius * angle) {
      return angle > same_direction;
    }
    return shape_.tolerance > 0.0 && 0.125 * angle * farther > shape_.tolerance;
  }

  void add_sections()
  {
    const std::size_t last = polyline_.points.size() - 1;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= last; ++i) {
      if (i < last && !is_corner(i)) {
        continue;
      }
      add_section(first, i);
      s_of_point_[i] = path_.length();
      if (i < last) {
        corners_.push_back({path_.pieces.size(), i});
      }
      first = i;
    }
  }

  // Whether all points from first to last lie on the line between these two.
  bool is_collinear(std::size_t first, std::size_t last) const
  {
    const Joints chord = polyline_.points[last] - polyline_.points[first];
    const Joints along = chord / chord.matrix().norm();
    for (std::size_t i = first + 1; i < last; ++i) {
      const Joints offset = polyline_.points[i] - polyline_.points[first];
      const double forward = (offset * along).sum();
      if ((offset - forward * along).abs().maxCoeff() > same_position || !(forward > 0.0)) {
        return false;
      }
    }
    return true;
  }

  void add_section(std::size_t first, std::size_t last)
  {
    if (is_collinear(first, last)) {
      add_collinear_section(first, last);
      return;
    }
    const std::span points(polyline_.points.data() + first, last - first + 1);
    const std::span widths(polyline_.length.data() + first, last - first);
    const auto slopes = natural_spline_slopes(points, widths);
    for (std::size_t i = first; i < last; ++i) {
      s_of_point_[i] = path_.length();
      add(cubic_piece(polyline_.points[i], polyline_.points[i + 1], slopes[i - first], slopes[i - first + 1],
                      polyline_.length[i]));
    }
  }

  void add_collinear_section(std::size_t first, std::size_t last)
  {
    const double begin = path_.length();
    const Joints chord = polyline_.points[last] - polyline_.points[first];
    const double length = chord.matrix().norm();
    for (std::size_t i = first; i < last; ++i) {
      s_of_point_[i] = begin + ((polyline_.points[i] - polyline_.points[first]) * chord).sum() / length;
    }
    add_line(polyline_.points[first], chord / length, length);
  }

  // --- corners ---

  struct Corner {
    std::size_t piece = 0;  // first piece after the corner
    std::size_t point = 0;
  };

  // Distance from the corner at which its blend starts and ends. The direction changes along the quintic
  // smoothstep, so between straight lines the middle of the blend passes the corner at a distance of 2 *
  // (5/64) * half_length * |d1 - d0|.
  double blend_half_length(const PathPiece & before, const PathPiece & after, const Joints & corner) const
  {
    constexpr double deviation = 2.0 * 5.0 / 64.0;
    const double turn = (after.at(0.0).d1 - before.at(before.length).d1).abs().maxCoeff();
    double half_length =
        std::min({shape_.tolerance / (deviation * turn), 0.5 * before.length, 0.5 * after.length});
    for (; half_length > smallest_blend; half_length *= 0.8) {
      const PathPiece blend = make_blend(before, after, half_length);
      if ((blend.at(half_length).q - corner).abs().maxCoeff() <= shape_.tolerance * (1.0 + 1e-9)) {
        return half_length;
      }
    }
    return 0.0;
  }

  // Polynomial that continues three derivatives on both sides. Between straight lines it has degree six, with
  // q' = d0 + (d1 - d0) (10 x^3 - 15 x^4 + 6 x^5), and stays inside the triangle of the corner.
  static PathPiece make_blend(const PathPiece & before, const PathPiece & after, double half_length)
  {
    PathPiece blend;
    blend.length = 2.0 * half_length;
    blend.degree = 7;
    const double l = blend.length;
    const PathPoint from = before.at(before.length - half_length);
    const PathPoint to = after.at(half_length);
    blend.c[0] = from.q;
    blend.c[1] = from.d1 * l;
    blend.c[2] = from.d2 * (l * l / 2.0);
    blend.c[3] = from.d3 * (l * l * l / 6.0);
    // Remaining differences at x = 1 of the position and of x-derivatives 1 to 3.
    const Joints e0 = to.q - blend.c[0] - blend.c[1] - blend.c[2] - blend.c[3];
    const Joints e1 = to.d1 * l - blend.c[1] - 2.0 * blend.c[2] - 3.0 * blend.c[3];
    const Joints e2 = to.d2 * (l * l) - 2.0 * blend.c[2] - 6.0 * blend.c[3];
    const Joints e3 = to.d3 * (l * l * l) - 6.0 * blend.c[3];
    blend.c[4] = 35.0 * e0 - 15.0 * e1 + 2.5 * e2 - e3 / 6.0;
    blend.c[5] = -84.0 * e0 + 39.0 * e1 - 7.0 * e2 + 0.5 * e3;
    blend.c[6] = 70.0 * e0 - 34.0 * e1 + 6.5 * e2 - 0.5 * e3;
    blend.c[7] = -20.0 * e0 + 10.0 * e1 - 2.0 * e2 + e3 / 6.0;
    return blend;
  }

  // `piece` without a length `head` at its start and `tail` at its end.
  static PathPiece trim(const PathPiece & piece, double head, double tail)
  {
    PathPiece rest = piece;
    rest.length = piece.length - head - tail;
    const PathPoint point = piece.at(head);
    rest.c[0] = point.q;
    rest.c[1] = point.d1 * rest.length;
    if (!piece.is_line()) {  // a cubic
      rest.c[2] = point.d2 * (rest.length * rest.length / 2.0);
      rest.c[3] = point.d3 * (rest.length * rest.length * rest.length / 6.0);
    }
    return rest;
  }

  // Adds a stop or a blend at each corner. Both preserve the parameter s of all other points.
  void blend_corners()
  {
    const std::vector<PathPiece> pieces = std::move(path_.pieces);
    path_.pieces.clear();
    auto corner = corners_.begin();
    double head = 0.0;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const bool ends_in_corner = corner != corners_.end() && corner->piece == k + 1;
      const double half_length =
          ends_in_corner && shape_.tolerance > 0.0
              ? blend_half_length(pieces[k], pieces[k + 1], polyline_.points[corner->point])
              : 0.0;
      if (pieces[k].length - head - half_length > 1e-12 * pieces[k].length) {
        add(head > 0.0 || half_length > 0.0 ? trim(pieces[k], head, half_length) : pieces[k]);
      }
      if (half_length > 0.0) {
        add(make_blend(pieces[k], pieces[k + 1], half_length));
      } else if (ends_in_corner) {
        path_.stops.push_back(path_.pieces.size());
      }
      corner += ends_in_corner ? 1 : 0;
      head = half_length;
    }
  }

  std::vector<Corner> corners_;
  Polyline polyline_;
  PathShape shape_;
  Path path_;
  std::vector<double> s_of_point_;  // s of each point of the polyline
};

}  // namespace

Path build_path(const std::vector<Joints> & waypoints, const PathShape & shape)
{
  return Builder(waypoints, shape).build();
}

}  // namespace ur_ros_rtde::trajectory
