#pragma once

#include <string_view>
#include <trajectory_msgs/msg/joint_trajectory.hpp>
#include <vector>

#include "streaming/servo_stream.hpp"
#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde_trajectory/goal_ranges.hpp"
#include "ur_ros_rtde_trajectory/timed.hpp"

namespace ur_ros_rtde {

/// Fails the check with the error of `status`, if it has one.
void require(Check & check, const Status & status);

/// Checks the limits of a goal: empty, or one value per joint, each above zero and at most `max`.
void check_limits(Check & check, std::string_view field, const std::vector<double> & values,
                  const trajectory::Joints & max, std::string_view unit);

/// Checks the fields that the goals of trajectories have in common: max_velocity, max_acceleration, max_jerk,
/// lookahead_time, gain, max_tracking_error.
template <typename Goal>
void check_trajectory_goal(Check & check, const Goal & goal, const ArmLimits & arm)
{
  using trajectory::Joints;
  check_limits(check, "max_velocity", goal.max_velocity, Eigen::Map<const Joints>(arm.velocity.data()),
               "rad/s");
  check_limits(check, "max_acceleration", goal.max_acceleration,
               Joints::Constant(trajectory::max_goal_acceleration), "rad/s^2");
  check_limits(check, "max_jerk", goal.max_jerk, Joints::Constant(trajectory::max_goal_jerk), "rad/s^3");
  check.in_range("lookahead_time", goal.lookahead_time, 0.03, 0.2, "s")
      .in_range("gain", goal.gain, 100.0, 2000.0)
      .above_zero("max_tracking_error", goal.max_tracking_error, 3.14, "rad");
}

/// The limits of a goal that check_trajectory_goal() has accepted. Empty fields keep the values of `limits`.
template <typename Goal>
trajectory::Limits goal_limits(const Goal & goal, trajectory::Limits limits)
{
  const auto replace = [](trajectory::Joints & limit, const std::vector<double> & given) {
    if (!given.empty()) {
      limit = Eigen::Map<const trajectory::Joints>(given.data());
    }
  };
  replace(limits.velocity, goal.max_velocity);
  replace(limits.acceleration, goal.max_acceleration);
  replace(limits.jerk, goal.max_jerk);
  return limits;
}

/// Converts a vector that is known to have six values.
inline trajectory::Joints to_joints(const std::vector<double> & values)
{
  return Eigen::Map<const trajectory::Joints>(values.data());
}

/// The index in `names` of each joint of the arm. The names may be in any order and have a common prefix.
/// Empty `names` mean the order of UR.
Expected<std::array<std::size_t, 6>> joint_order(const std::vector<std::string> & names);

/// Converts the points of a trajectory to the joint order of UR, without those that are too close to another
/// one (trajectory::drop_close_waypoints). Fails if the trajectory is incomplete. Does not check limits.
Expected<trajectory::TimedWaypoints> timed_waypoints(const trajectory_msgs::msg::JointTrajectory & message);

}  // namespace ur_ros_rtde
