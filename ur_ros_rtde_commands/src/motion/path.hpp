#pragma once

#include <functional>
#include <ur_ros_rtde_msgs/msg/path_waypoint.hpp>
#include <vector>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/run.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

using Waypoints = std::vector<ur_ros_rtde_msgs::msg::PathWaypoint>;

/// 1 to 1000 waypoints, each right in itself; then the first of them are asked of the robot (reachable).
/// `name` is the field: "waypoints"; `pose` what leads from an entry of it to its pose.
void check_path(Check & check, std::string_view name, const Waypoints & waypoints,
                std::string_view pose = ".pose");

/// Their poses, for warn_of_turn_to_identity().
std::vector<PathPose> path_poses(const Waypoints & waypoints);

/// Moves through the waypoints by a program in the place of the control program (hold Resource::script), with
/// progress, and `heading_for` with each waypoint's index when the arm turns to it. `arc_mode` is movec's
/// mode.
///
/// Not by ur_rtde's movePath: it sends the control program anew with the path in it, waits for that holding
/// the interface, has no arcs, and an error in the path ends it in silence.
Outcome run_path(Run & run, const Waypoints & waypoints,
                 const std::function<void(std::uint32_t)> & heading_for, int arc_mode = 0);

}  // namespace ur_ros_rtde
