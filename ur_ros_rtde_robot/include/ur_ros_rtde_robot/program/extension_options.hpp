#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// How long Robot::run_extension may take.
struct ExtensionOptions {
  std::chrono::milliseconds limit{10'000};
  /// Asked with each package: why it has to end early, if it has to.
  std::function<std::optional<Error>()> interrupted;
};

}  // namespace ur_ros_rtde
