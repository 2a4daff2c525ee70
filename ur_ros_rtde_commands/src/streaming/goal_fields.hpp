#pragma once

#include <string_view>
#include <trajectory_msgs/msg/joint_trajectory.hpp>
#include <vector>

#include "streaming/servo_stream.hpp"
#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde_trajectory/timed.hpp"

namespace ur_ros_rtde {

/// What a check says that knows nothing of goals.
void require(Check & check, const Status & status);

/// The limits of a goal: none, or one a joint, each above zero and at most `highest`.
void check_limits(Check & check, std::string_view field, const std::vector<double> & values,
                  const trajectory::Joints & highest, std::string_view unit);

/// What the goals for trajectories have in common: max_velocity, max_acceleration, max_jerk, lookahead_time,
/// gain, max_tracking_error.
template <typename Goal>
void check_trajectory_goal(Check & check, const Goal & goal, const ArmLimits & arm)
{
  using trajectory::Joints;
  check_limits(check, "max_velocity", goal.max_velocity, Eigen::Map<const Joints>(arm.velocity.data()),
               "rad/s");
  check_limits(check, "max_acceleration", goal.max_acceleration, Joints::Constant(40.0), "rad/s^2");
  check_limits(check, "max_jerk", goal.max_jerk, Joints::Constant(1e7), "rad/s^3");
  check.in_range("lookahead_time", goal.lookahead_time, 0.03, 0.2, "s")
      .in_range("gain", goal.gain, 100.0, 2000.0)
      .above_zero("max_tracking_error", goal.max_tracking_error, 3.14, "rad");
}

/// The goal's limits, which check_trajectory_goal() has passed; `limits` where it gives none.
template <typename Goal>
trajectory::Limits goal_limits(const Goal & goal, trajectory::Limits limits)
{
  const auto take = [](trajectory::Joints & limit, const std::vector<double> & given) {
    if (!given.empty()) {
      limit = Eigen::Map<const trajectory::Joints>(given.data());
    }
  };
  take(limits.velocity, goal.max_velocity);
  take(limits.acceleration, goal.max_acceleration);
  take(limits.jerk, goal.max_jerk);
  return limits;
}

/// Six values, as they are known to be.
inline trajectory::Joints to_joints(const std::vector<double> & values)
{
  return Eigen::Map<const trajectory::Joints>(values.data());
}

/// For each joint of the arm its place among `names`; `names` may be in any order and share a prefix; none:
/// UR's order.
Expected<std::array<std::size_t, 6>> joint_order(const std::vector<std::string> & names);

/// The points of a trajectory in UR's order. Refused: what is not complete or not finite. Does not look at
/// limits.
Expected<trajectory::TimedWaypoints> timed_waypoints(const trajectory_msgs::msg::JointTrajectory & message);

}  // namespace ur_ros_rtde
