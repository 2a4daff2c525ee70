#pragma once

#include <functional>
#include <string>

namespace ur_ros_rtde {

enum class LogLevel { debug, info, warn, error };

/// Receives log messages from any thread of this package. A lasting condition is logged once, not once per
/// cycle.
using LogFunction = std::function<void(LogLevel, const std::string &)>;

}  // namespace ur_ros_rtde
