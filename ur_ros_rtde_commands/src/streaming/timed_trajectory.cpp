#include "streaming/timed_trajectory.hpp"

#include "streaming/goal_fields.hpp"

namespace ur_ros_rtde {

void check_timed_trajectory(Check & check, const trajectory_msgs::msg::JointTrajectory & message,
                            const trajectory::Limits & limits, double start_tolerance)
{
  auto waypoints = timed_waypoints(message);
  require(check, waypoints.map([](const auto &) {}));
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
