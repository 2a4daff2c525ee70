#pragma once

#include <geometry_msgs/msg/pose.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// The orientation is exactly (0, 0, 0, 1), as in a pose message of which only the position was set.
bool has_identity_orientation(const geometry_msgs::msg::Pose & pose);

/// Where a motion to a single pose leads that begins at `start`, as a pose of UR. An identity orientation
/// keeps the orientation that the TCP has, unless `identity_orientation` says that it is meant.
std::vector<double> tcp_target(const geometry_msgs::msg::Pose & pose, bool identity_orientation,
                               const Sample & start);

/// The same for a goal with these two fields.
template <typename Goal>
std::vector<double> tcp_target(const Goal & goal, const Sample & start)
{
  return tcp_target(goal.pose, goal.identity_orientation, start);
}

/// Check::reachable for the goal's tcp_target() from where the arm is.
template <typename Goal>
Check & check_tcp_target(Check & check, const Goal & goal)
{
  if (const auto start = check.start()) {
    check.reachable("pose", tcp_target(goal, *start));
  }
  return check;
}

/// A pose of a path, with the name of its field; without a pose where joint positions are given.
struct PathPose {
  std::string name;
  std::optional<geometry_msgs::msg::Pose> pose;
};

/// "poses[0]", "poses[1]", …
std::vector<PathPose> path_poses(const std::string & field,
                                 const std::vector<geometry_msgs::msg::Pose> & poses);

/// What is to be said of the first pose of a path from `start` with an identity orientation to which the tool
/// turns by more than 90 degrees: a path cannot keep an orientation, and a user who gave positions only does
/// not expect it. Empty if there is none.
std::string turn_to_identity(const Vector6 & start, const std::vector<PathPose> & path);

/// Run::warn of that.
void warn_of_turn_to_identity(Run & run, const std::vector<PathPose> & path);

}  // namespace ur_ros_rtde
