#pragma once

#include <vector>

#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde::kinematics {

/// Path of the TCP through poses: straight lines with constant rotation rate, and corners blended within
/// `blend_radius`. The parameter u is the path length in m. If the TCP mainly rotates, one radian counts as
/// 0.2 m.
class TcpPath {
 public:
  /// Requires at least one pose. Repeated poses are merged.
  TcpPath(const std::vector<Pose> & poses, double blend_radius);

  double length() const { return corners_.back(); }
  Pose at(double u) const;
  /// u of each pose, or of the nearest point of the path.
  const std::vector<double> & waypoints() const { return waypoints_; }
  /// u of the corners where the TCP has to stop, including both ends.
  std::vector<double> stops() const;

 private:
  struct Line {
    Pose from;
    Twist rate;  // derivative with respect to u
    double length = 0.0;
    Pose at(double u) const { return moved(from, rate * u); }
  };

  double blend_half_length(std::size_t corner, double radius) const;

  std::vector<Line> lines_;
  std::vector<double> corners_;             // u at the start of each line, and at the end
  std::vector<double> blend_half_lengths_;  // half length of the blend at each corner; 0 at both ends
  std::vector<double> waypoints_;
};

}  // namespace ur_ros_rtde::kinematics
