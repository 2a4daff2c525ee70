#pragma once

#include <string>
#include <ur_ros_rtde_msgs/action/send_script.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

using SendScriptAction = ur_ros_rtde_msgs::action::SendScript;

/// A goal contains its script either as text or as the path of a file, at most 1,000,000 bytes.
void check_script_goal(const SendScriptAction::Goal & goal, Check & check);

/// Runs the script of the goal for at most `timeout` s, publishes its output as feedback, and fills in the
/// result.
Outcome run_script_goal(const SendScriptAction::Goal & goal, GoalRun<SendScriptAction> & run, ScriptKind kind,
                        double timeout);

}  // namespace ur_ros_rtde
