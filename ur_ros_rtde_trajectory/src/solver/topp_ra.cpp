#include "solver/topp_ra.hpp"

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde::trajectory {
namespace {

constexpr double negligible = 1e-12;  // smaller coefficients do not bound the acceleration

// Bound of the acceleration b along the path as a linear function of a, the squared speed.
struct Line {
  double offset = 0.0;
  double slope = 0.0;
  double at(double a) const { return offset + slope * a; }
};

// Bounds from |k2 a + k1 b| <= A of each joint, at both ends of an interval of width w (at the end, a becomes
// a + 2 w b).
struct Bounds {
  Line low{-1e12, 0.0};
  Line high{1e12, 0.0};
};

class Interval {
 public:
  Interval(const Grid & grid, const Limits & limits, std::size_t i)
      : width_(grid.width(i)),
        begin_1_(grid.d1[i]),
        begin_2_(grid.d2[i]),
        end_1_(grid.d1[i + 1] + 2.0 * width_ * grid.d2[i + 1]),
        end_2_(grid.d2[i + 1]),
        limit_(limits.acceleration)
  {
  }

  // Tightest bounds of b at this a.
  Bounds at(double a) const
  {
    Bounds bounds;
    bounds.low = {0.0, -1.0 / (2.0 * width_)};  // a >= 0 at the end
    tighten(begin_1_, begin_2_, a, bounds);
    tighten(end_1_, end_2_, a, bounds);
    return bounds;
  }

  // Largest a <= highest from which some b leads to at most `next`. low(a) - high(a) is convex, so Newton's
  // method converges from the right.
  double max_controllable(double highest, double next) const
  {
    double a = highest;
    for (int round = 0; round < 40; ++round) {
      Bounds bounds = at(a);
      const Line reach_next{next / (2.0 * width_), -1.0 / (2.0 * width_)};
      if (reach_next.at(a) < bounds.high.at(a)) {
        bounds.high = reach_next;
      }
      const double excess = bounds.low.at(a) - bounds.high.at(a);
      const double slope = bounds.low.slope - bounds.high.slope;
      if (excess <= 1e-12 * (1.0 + std::abs(bounds.low.at(a)))) {
        return a;
      }
      a = slope > 0.0 ? std::clamp(a - excess / slope, 0.0, a) : 0.5 * a;
    }
    return a;
  }

  double width() const { return width_; }

 private:
  void tighten(const Joints & k1, const Joints & k2, double a, Bounds & bounds) const
  {
    for (int j = 0; j < joint_count; ++j) {
      if (std::abs(k1[j]) < negligible) {
        continue;
      }
      const double half_range = limit_[j] / std::abs(k1[j]);
      const double slope = -k2[j] / k1[j];
      const double middle = slope * a;
      if (middle + half_range < bounds.high.at(a)) {
        bounds.high = {half_range, slope};
      }
      if (middle - half_range > bounds.low.at(a)) {
        bounds.low = {-half_range, slope};
      }
    }
  }

  double width_;
  Joints begin_1_, begin_2_, end_1_, end_2_, limit_;
};

double speed_ceiling(const Grid & grid, const Limits & limits, std::size_t i)
{
  double a = std::min(max_squared_speed(grid, i, limits), 1e12);
  const Joints & d3 = i < grid.intervals() ? grid.d3_begin[i] : grid.d3_end[i - 1];
  for (int j = 0; j < joint_count; ++j) {
    const double curvature = std::abs(grid.d2[i][j]);
    // If the joint hardly moves along the path, only a low speed limits its acceleration.
    if (curvature > 0.0 && std::abs(grid.d1[i][j]) < negligible) {
      a = std::min(a, limits.acceleration[j] / curvature);
    }
    if (d3[j] != 0.0 && std::isfinite(limits.jerk[j])) {
      a = std::min(a, std::cbrt(std::pow(limits.jerk[j] / std::abs(d3[j]), 2)));
    }
  }
  return a;
}

}  // namespace

double max_squared_speed(const Grid & grid, std::size_t station, const Limits & limits)
{
  const double speed = (limits.velocity / grid.d1[station].abs().max(1e-300)).minCoeff();
  const double top = std::min(speed, grid.max_speed[station]);
  return top * top;
}

Profile solve_topp_ra(const Grid & grid, const Limits & limits)
{
  const std::size_t count = grid.intervals();
  std::vector<double> controllable(count + 1,
                                   0.0);  // squared speeds from which the end can be reached at rest
  for (std::size_t i = count; i-- > 0;) {
    controllable[i] =
        Interval(grid, limits, i).max_controllable(speed_ceiling(grid, limits, i), controllable[i + 1]);
  }
  Profile profile;
  profile.v.assign(count + 1, 0.0);
  profile.alpha.assign(count + 1, 0.0);
  profile.time.assign(count, 0.0);
  double a = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Interval interval(grid, limits, i);
    const Bounds bounds = interval.at(a);
    const double next = std::clamp(a + 2.0 * interval.width() * bounds.high.at(a), 0.0, controllable[i + 1]);
    profile.alpha[i] = (next - a) / (2.0 * interval.width());
    profile.v[i + 1] = std::sqrt(next);
    profile.time[i] = 2.0 * interval.width() / std::max(profile.v[i] + profile.v[i + 1], 1e-12);
    a = next;
  }
  return profile;
}

}  // namespace ur_ros_rtde::trajectory
