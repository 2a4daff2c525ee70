#pragma once

#include <ur_ros_rtde_msgs/action/force_mode.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// What force_mode and force_mode_start have in common; `goal_ends_it`: force mode lasts as long as the goal.
void check_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, bool goal_ends_it,
                      Check & check);

/// Sets damping and gain, then switches force mode on, or changes it.
void start_force_mode(const ur_ros_rtde_msgs::action::ForceMode::Goal & goal, Run & run);

}  // namespace ur_ros_rtde
