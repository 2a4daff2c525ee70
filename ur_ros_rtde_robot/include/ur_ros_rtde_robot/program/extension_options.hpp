#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Options of Robot::run_extension().
struct ExtensionOptions {
  /// Time after which the extension is stopped.
  std::chrono::milliseconds timeout{10'000};
  /// Called every few milliseconds in the calling thread: the reason to stop the extension early, if there
  /// is one.
  std::function<std::optional<Error>()> stop_reason;
};

}  // namespace ur_ros_rtde
