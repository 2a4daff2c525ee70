#pragma once

#include <functional>
#include <ur_ros_rtde_msgs/msg/path_waypoint.hpp>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

using Waypoints = std::vector<ur_ros_rtde_msgs::msg::PathWaypoint>;

/// Checks 1 to 1000 waypoints, and the reachability of the first ones. `name` is the field: "waypoints".
/// `pose` is the path from one of its entries to the pose.
void check_path(Check & check, std::string_view name, const Waypoints & waypoints,
                std::string_view pose = ".pose");

/// The poses of the waypoints, for warn_of_identity_orientation().
std::vector<PathPose> path_poses(const Waypoints & waypoints);

/// Moves through the waypoints with a script that replaces the control program (requires Resource::script),
/// with progress. Calls `on_waypoint` with the index of each waypoint when the arm starts to move to it.
/// `arc_mode` is the mode of movec.
///
/// This does not use movePath of ur_rtde: movePath uploads the control program again with the path in it,
/// locks the interface while it waits, does not support arcs, and does not report errors in the path.
Outcome run_path(Run & run, const Waypoints & waypoints,
                 const std::function<void(std::uint32_t)> & on_waypoint, int arc_mode = 0);

}  // namespace ur_ros_rtde
