#include "kinematics/tcp_path.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/displacement_norm.hpp"

namespace ur_ros_rtde::kinematics {
namespace {

constexpr double same_pose = 1e-7;       // m
constexpr double same_direction = 1e-6;  // smaller changes of direction are ignored
// Distance of a blend from its corner per half length and change of direction: twice the integral of the
// smoothstep up to its middle.
constexpr double blend_deviation = 2.0 * 5.0 / 64.0;

double larger_displacement(const Twist & twist)
{
  return std::max(twist.head<3>().norm(), characteristic_length * twist.tail<3>().norm());
}

// Integral from 0 to x of the smoothstep 10 x^3 - 15 x^4 + 6 x^5.
double step_integral(double x)
{
  return x * x * x * x * (2.5 + x * (-3.0 + x));
}

}  // namespace

TcpPath::TcpPath(const std::vector<Pose> & poses, double blend_radius)
{
  corners_.push_back(0.0);
  waypoints_.push_back(0.0);
  Pose last = poses.front();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Twist displacement = difference(last, poses[i]);
    const double length = larger_displacement(displacement);
    if (length > same_pose) {
      lines_.push_back({last, displacement / length, length});
      corners_.push_back(corners_.back() + length);
      last = poses[i];
    }
    waypoints_.push_back(corners_.back());
  }
  if (lines_.empty()) {
    lines_.push_back({last, Twist::Zero(), 0.0});
    corners_.push_back(0.0);
  }
  blend_half_lengths_.assign(corners_.size(), 0.0);
  for (std::size_t k = 1; k < lines_.size(); ++k) {
    blend_half_lengths_[k] = blend_half_length(k, blend_radius);
  }
}

double TcpPath::blend_half_length(std::size_t corner, double radius) const
{
  const Line & before = lines_[corner - 1];
  const Line & after = lines_[corner];
  const double direction_change = larger_displacement(after.rate - before.rate);
  return std::min({radius / (blend_deviation * std::max(direction_change, same_direction)),
                   0.5 * before.length, 0.5 * after.length});
}

Pose TcpPath::at(double u) const
{
  const auto after = std::upper_bound(corners_.begin() + 1, corners_.end() - 1, u);
  const auto line = static_cast<std::size_t>(after - corners_.begin()) - 1;
  const double along = std::clamp(u - corners_[line], 0.0, lines_[line].length);
  const double left = lines_[line].length - along;
  const bool at_end = left < blend_half_lengths_[line + 1];
  const std::size_t corner = at_end ? line + 1 : line;
  if (!at_end && !(along < blend_half_lengths_[line])) {
    return lines_[line].at(along);
  }
  // Combines the remaining displacement along the line before the corner and the displacement along the line
  // after it.
  const double blend = blend_half_lengths_[corner];
  const double x = std::clamp((u - corners_[corner] + blend) / (2.0 * blend), 0.0, 1.0);
  const Pose from = lines_[corner - 1].at(lines_[corner - 1].length - 2.0 * blend * step_integral(1.0 - x));
  return moved(from, lines_[corner].rate * (2.0 * blend * step_integral(x)));
}

std::vector<double> TcpPath::stops() const
{
  std::vector<double> stops{0.0};
  for (std::size_t k = 1; k < lines_.size(); ++k) {
    const double direction_change = larger_displacement(lines_[k].rate - lines_[k - 1].rate);
    if (direction_change > same_direction && !(blend_half_lengths_[k] > same_pose)) {
      stops.push_back(corners_[k]);
    }
  }
  stops.push_back(length());
  return stops;
}

}  // namespace ur_ros_rtde::kinematics
