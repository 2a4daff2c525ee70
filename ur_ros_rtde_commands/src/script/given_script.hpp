#pragma once

#include <string>
#include <ur_ros_rtde_msgs/action/send_script.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

using SendScriptAction = ur_ros_rtde_msgs::action::SendScript;

/// A goal gives its script either as text or as the path of a file; neither may be larger than a megabyte.
void check_script(const SendScriptAction::Goal & goal, Check & check);

/// Runs the goal's script, with its output as feedback, and puts what became of it into the result.
Outcome run_given(const SendScriptAction::Goal & goal, GoalRun<SendScriptAction> & run, ScriptKind kind,
                  double limit);

}  // namespace ur_ros_rtde
