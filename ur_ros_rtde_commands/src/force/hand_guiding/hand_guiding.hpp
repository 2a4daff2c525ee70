#pragma once

#include <ur_ros_rtde_msgs/action/freedrive.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {

/// Checks a goal of freedrive or freedrive_start. `ends_with_goal`: freedrive lasts as long as the goal.
void check_freedrive(const ur_ros_rtde_msgs::action::Freedrive::Goal & goal, bool ends_with_goal,
                     Check & check);

/// Allows the operator to move the arm by hand in the axes of the goal.
Mode start_freedrive(Run & run, const ur_ros_rtde_msgs::action::Freedrive::Goal & goal);

}  // namespace ur_ros_rtde
