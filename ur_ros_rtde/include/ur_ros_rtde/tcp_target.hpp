#pragma once

#include <geometry_msgs/msg/pose.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The orientation is exactly (0, 0, 0, 1), as in a pose message in which only the position was set.
bool has_identity_orientation(const geometry_msgs::msg::Pose & pose);

/// The target of a motion to a single pose that starts at `start`, as a UR pose. An identity orientation
/// keeps the current orientation of the TCP unless `identity_orientation` is set.
std::vector<double> tcp_target(const geometry_msgs::msg::Pose & pose, bool identity_orientation,
                               const Sample & start);

/// The same for a goal with the fields `pose` and `identity_orientation`.
template <typename Goal>
std::vector<double> tcp_target(const Goal & goal, const Sample & start)
{
  return tcp_target(goal.pose, goal.identity_orientation, start);
}

/// Check::reachable() for tcp_target() of the goal, from the current state.
template <typename Goal>
Check & check_tcp_target(Check & check, const Goal & goal)
{
  if (const auto start = check.start()) {
    check.reachable("pose", tcp_target(goal, *start));
  }
  return check;
}

/// A pose of a path with the name of its field. Empty `pose`: the path has joint positions there.
struct PathPose {
  std::string name;
  std::optional<geometry_msgs::msg::Pose> pose;
};

/// "poses[0]", "poses[1]", …
std::vector<PathPose> path_poses(const std::string & field,
                                 const std::vector<geometry_msgs::msg::Pose> & poses);

/// A warning about the first pose of a path from `start` that has an identity orientation and turns the tool
/// by more than 90 degrees. Paths do not keep the orientation, which surprises users who set positions only.
/// Empty if there is no such pose.
std::string identity_orientation_warning(const Vector6 & start, const std::vector<PathPose> & path);

/// Calls Run::warn() with the message of identity_orientation_warning().
void warn_of_identity_orientation(Run & run, const std::vector<PathPose> & path);

}  // namespace ur_ros_rtde
