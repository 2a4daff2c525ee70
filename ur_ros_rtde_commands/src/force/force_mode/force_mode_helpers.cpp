#include "force/force_mode/force_mode_helpers.hpp"

namespace ur_ros_rtde {
namespace {

ForceModeOptions to_options(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal)
{
  const auto & force = goal.wrench.force;
  const auto & torque = goal.wrench.torque;
  return {.task_frame = to_ur(goal.task_frame),
          .compliant = goal.compliant,
          .wrench = {force.x, force.y, force.z, torque.x, torque.y, torque.z},
          .type = goal.type,
          .limits = goal.limits,
          .damping = goal.damping,
          .gain_scaling = goal.gain_scaling};
}

}  // namespace

void check_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, bool ends_with_goal,
                      Check & check)
{
  if (check.frame("task_frame", goal.task_frame).ok()) {
    check_force_mode(check, to_options(goal));
  }
  check_end_of_mode(check, goal, ends_with_goal);
}

Mode start_force_mode(Run & run, const ur_ros_rtde_msgs::action::ForceMode::Goal & goal)
{
  return start_force_mode(run, to_options(goal));
}

}  // namespace ur_ros_rtde
