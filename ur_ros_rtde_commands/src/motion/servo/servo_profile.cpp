#include "motion/servo/servo_profile.hpp"

#include <algorithm>
#include <cmath>

#include "ur_ros_rtde_robot/state/conversions.hpp"
#include "ur_ros_rtde_trajectory/default_speeds.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double min_duration = 0.01;  // s
/// The peak acceleration of smooth_step for a distance of 1 in 1 s.
const double smooth_step_acceleration = 10.0 / std::sqrt(3.0);

/// The duration (s) of smooth_step over `distance` within the limits.
double default_duration(double distance, double speed, double acceleration)
{
  return std::max({min_duration, smooth_step_peak * distance / speed,
                   std::sqrt(smooth_step_acceleration * distance / acceleration)});
}

/// The pose `to` in the frame of the pose `from`.
Vector6 relative_pose(const Vector6 & from, const std::vector<double> & to)
{
  Vector6 target;
  std::copy_n(to.begin(), target.size(), target.begin());
  return pose_trans(pose_inverse(from), target);
}
}  // namespace

double smooth_step(double u)
{
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

PoseDistance pose_distance(const Vector6 & from, const std::vector<double> & to)
{
  const Vector6 offset = relative_pose(from, to);
  return {length(position(offset)), length(rotation(offset))};
}

double default_joint_duration(const Vector6 & from, const std::vector<double> & to)
{
  double longest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    longest = std::max(longest, std::abs(to[i] - from[i]));
  }
  return default_duration(longest, default_joint_speed, default_joint_acceleration);
}

double default_tcp_duration(const Vector6 & from, const std::vector<double> & to)
{
  const PoseDistance distance = pose_distance(from, to);
  return std::max(default_duration(distance.linear, default_linear_speed, default_linear_acceleration),
                  default_duration(distance.angular, default_angular_speed, default_angular_acceleration));
}

std::vector<double> interpolate_joints(const Vector6 & from, const std::vector<double> & to, double s)
{
  std::vector<double> joints(from.begin(), from.end());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] += s * (to[i] - from[i]);
  }
  return joints;
}

std::vector<double> interpolate_pose(const Vector6 & from, const std::vector<double> & to, double s)
{
  Vector6 offset = relative_pose(from, to);
  for (double & value : offset) {
    value *= s;
  }
  const Vector6 pose = pose_trans(from, offset);
  return {pose.begin(), pose.end()};
}

}  // namespace ur_ros_rtde
