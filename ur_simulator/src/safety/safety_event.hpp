#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/error_code.hpp"
#include "state/modes.hpp"

namespace ur_simulator {

/// An entry of the robot's log.
struct SafetyEvent {
  enum class Level { information, warning, error };
  std::uint64_t cycle;
  double timestamp;  ///< s of simulated time
  Level level;
  RobotMode robot_mode;    ///< after the event
  SafetyMode safety_mode;  ///< after the event
  std::string message;
  std::optional<ErrorCode> code;     ///< of a stop
  bool entered_safety_mode = false;  ///< safety_mode has changed
};

}  // namespace ur_simulator
