#include "force/force_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_ros_rtde {
namespace {
constexpr double highest_force = 500.0;   // N
constexpr double highest_torque = 100.0;  // Nm
constexpr double highest_limit = 10.0;    // m/s, rad/s, m, rad: above it there is no limit to speak of
}  // namespace

void check_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, bool goal_ends_it,
                      Check & check)
{
  check.frame("task_frame", goal.task_frame)
      .that(std::any_of(goal.compliant.begin(), goal.compliant.end(), [](bool axis) { return axis; }),
            "compliant has no true: at least one axis has to follow the force")
      .vector("wrench.force", goal.wrench.force, highest_force, "N")
      .vector("wrench.torque", goal.wrench.torque, highest_torque, "Nm")
      .in_range("type", goal.type, 1, 3)
      .in_range("damping", goal.damping, 0.0, 1.0)
      .in_range("gain_scaling", goal.gain_scaling, 0.0, 2.0);
  for (std::size_t i = 0; i < goal.limits.size(); ++i) {
    check.above_zero(fmt::format("limits[{}]", i), goal.limits[i], highest_limit);
  }
  duration_of(check, goal.duration, goal_ends_it);
}

void start_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, Run & run)
{
  using Control = ur_rtde::RTDEControlInterface;
  must_not_be_in(run, Control::MOTION_FREEDRIVE | Control::MOTION_TEACH, "force mode");
  const auto & force = goal.wrench.force;
  const auto & torque = goal.wrench.torque;
  must_do(run.control()->forceModeSetDamping(goal.damping), "set the damping of force mode");
  must_do(run.control()->forceModeSetGainScaling(goal.gain_scaling), "set the gain of force mode");
  must_do(run.control()->forceMode(to_ur(goal.task_frame), to_ints(goal.compliant),
                                   {force.x, force.y, force.z, torque.x, torque.y, torque.z}, goal.type,
                                   {goal.limits.begin(), goal.limits.end()}),
          "enter force mode");
}

}  // namespace ur_ros_rtde
