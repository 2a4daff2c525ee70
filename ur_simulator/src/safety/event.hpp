#pragma once

#include <cstdint>
#include <string>

#include "state/modes.hpp"

namespace ur_simulator {

/// Something that the log of a robot would show.
struct SafetyEvent {
  enum class Level { information, warning, error };
  std::uint64_t cycle;
  double timestamp;  ///< s of simulated time
  Level level;
  RobotMode robot_mode;    ///< after it
  SafetyMode safety_mode;  ///< after it
  std::string message;
};

}  // namespace ur_simulator
