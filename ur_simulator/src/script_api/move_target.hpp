#pragma once

#include "motion/arm.hpp"
#include "script_api/motion_operation.hpp"
#include "urscript/argument_reader.hpp"

namespace ur_simulator::script_api {

// Helpers of the builtins that move to a target.

/// The TCP pose of a target given as a pose or as joint positions.
Vector6 tcp_target(const RobotContext & robot, const Value & target, const Vector6 & target_values);
/// The joint positions of a target given as joint positions or as a pose; for a pose, the nearest inverse
/// solution.
tl::expected<Vector6, std::string> joint_target(const RobotContext & robot, const Value & target,
                                                const Vector6 & target_values);

/// Starts a motion along a path. A motion that is skipped is reported in the log.
Outcome start_path_move(const RobotContextPtr & robot, CallContext & context,
                        MoveOperation::StartFunction start);

/// A motion of the arm to a target with options: &Arm::move_joint, &Arm::move_linear, …
using MoveFunction = StartResult (Arm::*)(const Vector6 & target, const MoveOptions & options);
/// Reads the options from the arguments after the target.
using OptionsReader = MoveOptions (*)(ArgumentReader & reader);

/// Calls a motion to the joint positions given by the first argument, `target_name`.
Outcome move_to_joints(const RobotContextPtr & robot, CallContext & context, Arguments arguments,
                       const char * target_name, OptionsReader read_options, MoveFunction move);
/// Calls a motion to the TCP pose given by the first argument, `target_name`.
Outcome move_to_pose(const RobotContextPtr & robot, CallContext & context, Arguments arguments,
                     const char * target_name, OptionsReader read_options, MoveFunction move);

void add_path_builtins(Library & library, const RobotContextPtr & robot);

}  // namespace ur_simulator::script_api
