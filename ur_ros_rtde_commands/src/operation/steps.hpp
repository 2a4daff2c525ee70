#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// Calls `step` until it has nothing left to do, and publishes what it says it is doing, on each change.
template <typename GoalRun>
Outcome take_steps(GoalRun & run, double timeout, const std::function<std::string()> & step)
{
  constexpr std::chrono::milliseconds interval{50};
  for (std::string doing = step(); !doing.empty(); doing = step()) {
    if (std::chrono::duration<double>(run.elapsed()).count() > timeout) {
      return Outcome::failure(ErrorCode::timeout, "the time is over, still " + doing);
    }
    if (run.feedback().state != doing) {
      run.feedback().state = doing;
      run.publish();
    }
    if (auto why = run.sleep_for(interval)) {
      return *why;
    }
  }
  return Outcome::success();
}

}  // namespace ur_ros_rtde
