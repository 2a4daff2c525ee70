#pragma once

#include <string>

#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Sends a line to the dashboard server and returns its answer. Throws RobotError (link_lost).
std::string ask_dashboard(const Robot & robot, const std::string & line);
/// The same without the label that answers to questions have: "RUNNING" of "Robotmode: RUNNING".
std::string dashboard_value(const Robot & robot, const std::string & question);
/// Gives a command, whose answer has to begin with `reply`; rejected_by_robot with the answer otherwise.
Status tell_dashboard(const Robot & robot, const std::string & line, const std::string & reply);

}  // namespace ur_ros_rtde
