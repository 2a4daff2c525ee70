#pragma once

#include <vector>

#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

/// The minimum-jerk polynomial (Flash and Hogan 1985): the traveled fraction of the path at the fraction `u`
/// of the duration, both 0 to 1. It starts and ends at rest with continuous acceleration.
double smooth_step(double u);
/// The peak speed of smooth_step as a multiple of its mean speed.
constexpr double smooth_step_peak = 15.0 / 8.0;

/// The distance (m) and the angle (rad) between two UR poses.
struct PoseDistance {
  double linear;
  double angular;
};
PoseDistance pose_distance(const Vector6 & from, const std::vector<double> & to);

/// The duration (s) of a goal without a time: what the joints, or the TCP, need with the default speeds and
/// accelerations (default_speeds.hpp).
double default_joint_duration(const Vector6 & from, const std::vector<double> & to);
double default_tcp_duration(const Vector6 & from, const std::vector<double> & to);

/// Linear interpolation at the fraction `s`: of joint positions, and of UR poses, on a straight line with a
/// rotation about a fixed axis.
std::vector<double> interpolate_joints(const Vector6 & from, const std::vector<double> & to, double s);
std::vector<double> interpolate_pose(const Vector6 & from, const std::vector<double> & to, double s);

}  // namespace ur_ros_rtde
