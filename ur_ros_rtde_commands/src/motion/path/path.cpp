#include "motion/path/path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <ur_ros_rtde_msgs/action/move_c.hpp>

#include "motion/speed_limits.hpp"

namespace ur_ros_rtde {
namespace {
using Waypoint = ur_ros_rtde_msgs::msg::PathWaypoint;

constexpr std::size_t max_waypoints = 1000;
/// Only the first waypoints are checked for reachability, because each check takes some milliseconds.
constexpr std::size_t reachability_checks = 20;
constexpr std::chrono::hours max_path_duration{24};
constexpr std::string_view waypoint_marker = "ur_ros_rtde: waypoint ";

void check_waypoint(Check & check, const std::string & name, std::string_view pose, const Waypoint & waypoint)
{
  const bool has_joint_positions = !waypoint.joint_positions.empty();
  check.in_range(name + ".type", waypoint.type, Waypoint::MOVE_J, Waypoint::MOVE_C)
      .pose(fmt::format("{}{}", name, pose), waypoint.pose)
      .position(name + ".via", waypoint.via.position)
      .that(!has_joint_positions || waypoint.type <= Waypoint::MOVE_L,
            name + " has joint_positions, which MOVE_P and MOVE_C do not support: set its pose");
  if (has_joint_positions) {
    check.joints(name + ".joint_positions", waypoint.joint_positions);
  }
  const SpeedLimits & limits = waypoint.type == Waypoint::MOVE_J ? joint_speed_limits : linear_speed_limits;
  check_speed(check, waypoint, limits, name + ".")
      .in_range(name + ".blend_radius", waypoint.blend_radius, 0.0, 2.0, "m");
}

std::string pose_text(const geometry_msgs::msg::Pose & pose)
{
  return fmt::format("p[{:.9f}]", fmt::join(to_ur(pose), ", "));
}

bool has_position_only(const Waypoint & waypoint, int arc_mode)
{
  return waypoint.type == Waypoint::MOVE_C && arc_mode == ur_ros_rtde_msgs::action::MoveC::Goal::FIXED;
}

/// Without the orientation, which movec does not use in the point on the way, nor, in FIXED mode, at the end.
std::string position_text(const geometry_msgs::msg::Pose & pose)
{
  const auto & p = pose.position;
  return fmt::format("p[{:.9f}, {:.9f}, {:.9f}, 0, 0, 0]", p.x, p.y, p.z);
}

/// The URScript call for one waypoint (UR, Script Manual: movej, movel, movep, movec).
std::string motion_call(const Waypoint & waypoint, int arc_mode)
{
  const std::string target = has_position_only(waypoint, arc_mode) ? position_text(waypoint.pose)
                             : waypoint.joint_positions.empty()
                                 ? pose_text(waypoint.pose)
                                 : fmt::format("[{:.9f}]", fmt::join(waypoint.joint_positions, ", "));
  const std::string speed = fmt::format("a={:.6f}, v={:.6f}, r={:.6f}", waypoint.acceleration, waypoint.speed,
                                        waypoint.blend_radius);
  switch (waypoint.type) {
    case Waypoint::MOVE_J:
      return fmt::format("movej({}, {})", target, speed);
    case Waypoint::MOVE_L:
      return fmt::format("movel({}, {})", target, speed);
    case Waypoint::MOVE_P:
      return fmt::format("movep({}, {})", target, speed);
    default:
      return fmt::format("movec({}, {}, {}, mode={})", position_text(waypoint.via), target, speed, arc_mode);
  }
}

std::string path_program(const Waypoints & waypoints, int arc_mode)
{
  std::string text;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    text += fmt::format("textmsg(\"{}{}\")\n{}\n", waypoint_marker, i, motion_call(waypoints[i], arc_mode));
  }
  return text;
}
}  // namespace

void check_path(Check & check, std::string_view name, const Waypoints & waypoints, std::string_view pose)
{
  check.that(!waypoints.empty() && waypoints.size() <= max_waypoints,
             fmt::format("{} has {} entries, it may have 1 to {}", name, waypoints.size(), max_waypoints));
  for (std::size_t i = 0; i < waypoints.size() && check.ok(); ++i) {
    check_waypoint(check, fmt::format("{}[{}]", name, i), pose, waypoints[i]);
  }
  if (check.ok()) {
    check.that(
        waypoints.back().blend_radius == 0.0,
        fmt::format("the last of {} has a blend_radius of {} m: set it to 0, because the arm stops there",
                    name, waypoints.back().blend_radius));
  }
  for (std::size_t i = 0; i < std::min(waypoints.size(), reachability_checks) && check.ok(); ++i) {
    if (waypoints[i].joint_positions.empty()) {
      check.reachable(fmt::format("{}[{}]{}", name, i, pose), waypoints[i].pose);
    }
  }
}

std::vector<PathPose> path_poses(const Waypoints & waypoints)
{
  std::vector<PathPose> poses;
  for (const Waypoint & waypoint : waypoints) {
    const bool has_joint_positions = !waypoint.joint_positions.empty();
    poses.push_back({fmt::format("waypoints[{}].pose", poses.size()),
                     has_joint_positions ? std::nullopt : std::optional(waypoint.pose)});
  }
  return poses;
}

Outcome run_path(Run & run, const Waypoints & waypoints,
                 const std::function<void(std::uint32_t)> & on_waypoint, int arc_mode)
{
  ScriptOptions options;
  options.timeout = max_path_duration;
  options.on_text = [&](const std::string & text) {
    std::uint32_t index = 0;
    if (text.starts_with(waypoint_marker) &&
        std::from_chars(text.data() + waypoint_marker.size(), text.data() + text.size(), index).ec ==
            std::errc()) {
      run.progress(index / static_cast<double>(waypoints.size()));
      on_waypoint(index);
    }
  };
  const ScriptReport report = run.run_script(path_program(waypoints, arc_mode), options);
  if (!report) {
    return report.error;
  }
  const Waypoint & last = waypoints.back();
  if (has_position_only(last, arc_mode)) {
    const auto & p = last.pose.position;
    return run.until_at_rest_at_position({p.x, p.y, p.z, 0.0, 0.0, 0.0});
  }
  return last.joint_positions.empty() ? run.until_at_rest_at_pose(to_ur(last.pose))
                                      : run.until_at_rest_at_joints(last.joint_positions);
}

}  // namespace ur_ros_rtde
