#pragma once

#include <ur_ros_rtde_msgs/action/force_mode.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// Checks a goal of force_mode or force_mode_start. `ends_with_goal`: force mode lasts as long as the goal.
void check_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, bool ends_with_goal,
                      Check & check);

/// Sets damping and gain, then activates force mode or changes its parameters.
Mode start_force_mode(Run & run, const ur_ros_rtde_msgs::action::ForceMode::Goal & goal);

}  // namespace ur_ros_rtde
