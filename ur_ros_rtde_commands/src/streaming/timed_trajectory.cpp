#include "streaming/timed_trajectory.hpp"

#include <fmt/format.h>

#include "streaming/goal_fields.hpp"

namespace ur_ros_rtde {
namespace {

/// The names are those of an arm: timed_waypoints().
void check_prefix(Check & check, const std::vector<std::string> & names, const std::string & own)
{
  if (!check.ok() || names.empty()) {
    return;
  }
  const std::string & name = names[(*joint_order(names))[0]];
  const std::string prefix = name.substr(0, name.size() - joint_names()[0].size());
  check.that(prefix.empty() || prefix == own,
             fmt::format("joint_names have the prefix \"{}\", but those of this arm have {}: send the "
                         "goal to the other arm, or set tf_prefix",
                         prefix, own.empty() ? std::string("none") : fmt::format("\"{}\"", own)));
}

}  // namespace

void check_timed_trajectory(Check & check, const trajectory_msgs::msg::JointTrajectory & message,
                            const trajectory::Limits & limits, double start_tolerance,
                            const std::string & prefix)
{
  auto waypoints = timed_waypoints(message);
  require(check, waypoints.map([](const auto &) {}));
  check_prefix(check, message.joint_names, prefix);
  if (!check.ok()) {
    return;
  }
  const trajectory::Joints first = to_joints(waypoints->positions.front());
  const bool starts_at_first = waypoints->times.front() == 0.0;
  trajectory::prepend_start(*waypoints, first);
  require(check, trajectory::check_timed(*waypoints, limits));
  if (const auto sample = check.start(); sample && starts_at_first) {
    require(check, check_start_position(first, commanded_joints(*sample), start_tolerance));
  }
}

Expected<trajectory::Trajectory> plan_timed_trajectory(const trajectory_msgs::msg::JointTrajectory & message,
                                                       const trajectory::Joints & start,
                                                       const trajectory::Limits & limits)
{
  auto waypoints = timed_waypoints(message);
  if (!waypoints) {
    return tl::unexpected(waypoints.error());
  }
  trajectory::prepend_start(*waypoints, start);
  return trajectory::plan_timed(*waypoints, limits);
}

}  // namespace ur_ros_rtde
