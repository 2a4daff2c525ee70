#pragma once

#include "motion/arm.hpp"
#include "script_api/motion_operation.hpp"

namespace ur_simulator::script_api {

// What the builtins that move to a target share.

/// A target given as a pose, or as joint positions where the TCP is then.
Vector6 tcp_target(const Robot & robot, const Value & target, const Vector6 & six);
/// A target given as joint positions, or as a pose for which the nearest posture is taken.
tl::expected<Vector6, std::string> joint_target(const Robot & robot, const Value & target,
                                                const Vector6 & six);

/// Starts a motion along a path; one that is skipped leaves a warning in the log.
Outcome begin_path(const RobotPtr & robot, CallContext & context, MoveOperation::Start start);

void add_path_builtins(Library & library, const RobotPtr & robot);

}  // namespace ur_simulator::script_api
