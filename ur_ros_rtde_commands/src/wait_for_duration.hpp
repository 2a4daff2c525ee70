#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Waits for `duration` (s of the controller's clock), or until the goal has to stop if it is 0. Updates the
/// progress and calls `observe` with every sample.
[[nodiscard]] inline std::optional<StopReason> wait_for_duration(
    Run & run, double duration, const std::function<void(const Sample &)> & observe = {})
{
  constexpr std::chrono::hours unlimited{24 * 365};
  constexpr double clock_reserve = 5.0;  // s. Limits the wait if the controller's clock stands still.
  const double begin = run.state().controller_time;
  const bool limited = duration > 0.0;
  const auto elapsed = [&] {
    const Sample now = run.state();
    const double time = now.controller_time - begin;
    run.progress(limited ? std::clamp(time / duration, 0.0, 1.0) : 0.0);
    if (observe) {
      observe(now);
    }
    return limited && time >= duration;
  };
  const std::chrono::duration<double> limit(duration + clock_reserve);
  return run.until(elapsed,
                   limited ? std::chrono::duration_cast<std::chrono::nanoseconds>(limit) : unlimited);
}

}  // namespace ur_ros_rtde
