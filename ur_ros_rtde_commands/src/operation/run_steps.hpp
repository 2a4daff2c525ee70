#pragma once

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <string>

#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// Calls `step` every 50 ms until it returns an empty string. The string describes the current activity; it
/// is published as feedback when it changes. Fails (timeout) after `timeout` s.
template <typename GoalRun>
Outcome run_steps(GoalRun & run, double timeout, const std::function<std::string()> & step)
{
  constexpr std::chrono::milliseconds interval{50};
  for (std::string activity = step(); !activity.empty(); activity = step()) {
    if (std::chrono::duration<double>(run.elapsed()).count() > timeout) {
      return Outcome::failure(ErrorCode::timeout,
                              fmt::format("not finished within {} s: still {}", timeout, activity));
    }
    if (run.feedback().state != activity) {
      run.feedback().state = activity;
      run.publish();
    }
    if (auto stop_reason = run.sleep_for(interval)) {
      return *stop_reason;
    }
  }
  return Outcome::success();
}

}  // namespace ur_ros_rtde
