#pragma once

#include <functional>
#include <string>

namespace ur_ros_rtde {

enum class LogLevel { debug, info, warn, error };

/// Receives what the robot side has to say, from any of its threads. It says each thing once, not once a
/// cycle.
using LogFunction = std::function<void(LogLevel, const std::string &)>;

}  // namespace ur_ros_rtde
