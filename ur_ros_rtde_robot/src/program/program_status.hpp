#pragma once

#include <string>
#include <string_view>

#include "program/program_state_machine.hpp"
#include "ur_ros_rtde_robot/robot_options.hpp"
#include "ur_ros_rtde_robot/robot_status.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Why the control program does not run although the robot could run it: what the program on the robot
/// prevents, and the remedy. `runtime` is the runtime state of the newest sample.
RobotStatus program_status(ProgramState state, const ProgramObservation & observation, RuntimeState runtime,
                           const RobotOptions & options);

/// RobotState::stopped with ErrorCode::program_stopped.
RobotStatus program_stopped(std::string message);

/// RobotState::stopped for another reason.
RobotStatus stopped_by(const Error & error);

/// The watchdog of `program`, of this frequency in Hz, has ended it after `gap` s without a heartbeat.
Error stopped_by_watchdog(std::string_view program, double gap, double frequency, std::string_view more);

}  // namespace ur_ros_rtde
