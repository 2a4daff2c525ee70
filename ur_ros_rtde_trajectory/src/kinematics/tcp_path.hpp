#pragma once

#include <vector>

#include "ur_ros_rtde_trajectory/arm.hpp"

namespace ur_ros_rtde::kinematics {

/// The way of the TCP through poses: straight lines, with a turn at a constant rate on each, and round
/// corners where `blend_radius` allows. The parameter u is the length of the way in metres, with 0.2 m a
/// radian where the TCP turns more than it moves.
class TcpPath {
 public:
  /// Poses that repeat their predecessor count as one. At least one pose.
  TcpPath(const std::vector<Pose> & poses, double blend_radius);

  double length() const { return corners_.back(); }
  Pose at(double u) const;
  /// u at which the way is at, or nearest to, each of the poses.
  const std::vector<double> & waypoints() const { return waypoints_; }
  /// u of the corners where the TCP has to stop, both ends included; at most `length` apart by themselves.
  std::vector<double> stops() const;

 private:
  struct Line {
    Pose from;
    Twist rate;  // by u
    double length = 0.0;
    Pose at(double u) const { return moved(from, rate * u); }
  };

  double blend_half_length(std::size_t corner, double radius) const;

  std::vector<Line> lines_;
  std::vector<double> corners_;             // u at the beginning of each line, and at the end
  std::vector<double> blend_half_lengths_;  // of the blend at each corner; 0 at both ends
  std::vector<double> waypoints_;
};

}  // namespace ur_ros_rtde::kinematics
