#pragma once

#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Whether the robot accepts motion commands.
enum class RobotState {
  disconnected,  ///< no controller at the address
  connecting,    ///< controller found; interfaces and control program are being set up
  ready,         ///< accepts motion commands, or runs a script in place of the control program
  stopped,       ///< connected, but unable to move; see the cause
};

const char * to_string(RobotState state);

/// The state of the connection to the robot and of its control program, with the cause of a problem.
struct RobotStatus {
  RobotState state = RobotState::disconnected;
  ErrorCode cause = ErrorCode::none;
  /// The problem and its remedy; empty if ready.
  std::string message;
};

}  // namespace ur_ros_rtde
