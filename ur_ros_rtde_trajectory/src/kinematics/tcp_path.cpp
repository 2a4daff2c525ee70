#include "kinematics/tcp_path.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/extent.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

constexpr double same_pose = 1e-7;    // m
constexpr double straight_on = 1e-6;  // change of direction below which a line goes on
// How far a blend passes from its corner, by its reach and the change of direction: twice the integral of the
// smooth step up to its middle.
constexpr double sag = 2.0 * 5.0 / 64.0;

double larger_extent(const Twist & twist)
{
  return std::max(twist.head<3>().norm(), arm_length * twist.tail<3>().norm());
}

// Integral from 0 to x of the step 10 x^3 - 15 x^4 + 6 x^5.
double step_integral(double x)
{
  return x * x * x * x * (2.5 + x * (-3.0 + x));
}

}  // namespace

TcpPath::TcpPath(const std::vector<Pose> & poses, double blend_radius)
{
  corners_.push_back(0.0);
  places_.push_back(0.0);
  Pose last = poses.front();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Twist way = difference(last, poses[i]);
    const double length = larger_extent(way);
    if (length > same_pose) {
      lines_.push_back({last, way / length, length});
      corners_.push_back(corners_.back() + length);
      last = poses[i];
    }
    places_.push_back(corners_.back());
  }
  if (lines_.empty()) {
    lines_.push_back({last, Twist::Zero(), 0.0});
    corners_.push_back(0.0);
  }
  reach_.assign(corners_.size(), 0.0);
  for (std::size_t k = 1; k < lines_.size(); ++k) {
    reach_[k] = reach_at(k, blend_radius);
  }
}

double TcpPath::reach_at(std::size_t corner, double radius) const
{
  const Line & before = lines_[corner - 1];
  const Line & after = lines_[corner];
  const double turn = larger_extent(after.rate - before.rate);
  return std::min({radius / (sag * std::max(turn, straight_on)), 0.5 * before.length, 0.5 * after.length});
}

Pose TcpPath::at(double u) const
{
  const auto after = std::upper_bound(corners_.begin() + 1, corners_.end() - 1, u);
  const auto line = static_cast<std::size_t>(after - corners_.begin()) - 1;
  const double along = std::clamp(u - corners_[line], 0.0, lines_[line].length);
  const double left = lines_[line].length - along;
  const bool at_end = left < reach_[line + 1];
  const std::size_t corner = at_end ? line + 1 : line;
  if (!at_end && !(along < reach_[line])) {
    return lines_[line].at(along);
  }
  // Backward along the line before the corner, by as much as is left of it; forward along the one after.
  const double reach = reach_[corner];
  const double x = std::clamp((u - corners_[corner] + reach) / (2.0 * reach), 0.0, 1.0);
  const Pose from = lines_[corner - 1].at(lines_[corner - 1].length - 2.0 * reach * step_integral(1.0 - x));
  return moved(from, lines_[corner].rate * (2.0 * reach * step_integral(x)));
}

std::vector<double> TcpPath::stops() const
{
  std::vector<double> stops{0.0};
  for (std::size_t k = 1; k < lines_.size(); ++k) {
    const double turn = larger_extent(lines_[k].rate - lines_[k - 1].rate);
    if (turn > straight_on && !(reach_[k] > same_pose)) {
      stops.push_back(corners_[k]);
    }
  }
  stops.push_back(length());
  return stops;
}

}  // namespace ur_ros_rtde::kinematics
