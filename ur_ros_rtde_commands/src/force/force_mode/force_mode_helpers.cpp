#include "force/force_mode/force_mode_helpers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde {
namespace {
constexpr double max_force = 500.0;   // N
constexpr double max_torque = 100.0;  // Nm
constexpr double max_limit = 10.0;    // m/s, rad/s, m or rad, depending on the axis
}  // namespace

void check_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, bool ends_with_goal,
                      Check & check)
{
  check.frame("task_frame", goal.task_frame)
      .that(std::any_of(goal.compliant.begin(), goal.compliant.end(), [](bool axis) { return axis; }),
            "compliant is false for all axes: at least one axis has to be true")
      .vector("wrench.force", goal.wrench.force, max_force, "N")
      .vector("wrench.torque", goal.wrench.torque, max_torque, "Nm")
      .in_range("type", goal.type, 1, 3)
      .in_range("damping", goal.damping, 0.0, 1.0)
      .in_range("gain_scaling", goal.gain_scaling, 0.0, 2.0);
  for (std::size_t i = 0; i < goal.limits.size(); ++i) {
    check.above_zero(fmt::format("limits[{}]", i), goal.limits[i], max_limit);
  }
  check_end_of_mode(check, goal, ends_with_goal);
}

Mode start_force_mode(Run & run, const ur_ros_rtde_msgs::action::ForceMode::Goal & goal)
{
  const auto & force = goal.wrench.force;
  const auto & torque = goal.wrench.torque;
  return start_force_mode(run, {.task_frame = to_ur(goal.task_frame),
                                .compliant = goal.compliant,
                                .wrench = {force.x, force.y, force.z, torque.x, torque.y, torque.z},
                                .type = goal.type,
                                .limits = goal.limits,
                                .damping = goal.damping,
                                .gain_scaling = goal.gain_scaling});
}

}  // namespace ur_ros_rtde
