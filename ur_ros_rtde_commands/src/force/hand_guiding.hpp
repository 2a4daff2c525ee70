#pragma once

#include <ur_ros_rtde_msgs/action/freedrive.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// What freedrive and freedrive_start have in common; `goal_ends_it`: freedrive lasts as long as the goal.
void check_freedrive(const ur_ros_rtde_msgs::action::Freedrive::Goal & goal, bool goal_ends_it,
                     Check & check);

/// Lets the arm be moved by hand, in some axes or in all of them (teach mode).
void start_freedrive(const ur_ros_rtde_msgs::action::Freedrive::Goal & goal, Run & run);
void start_teach_mode(Run & run);

}  // namespace ur_ros_rtde
