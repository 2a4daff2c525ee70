#pragma once

#include <functional>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/mode.hpp"

namespace ur_ros_rtde {

/// Waits for the end of a mode that lasts as long as its goal, and ends it: after `duration` (see
/// wait_for_duration()), or at a cancel, which counts as success.
Outcome end_mode_after(Run & run, double duration, Mode & mode,
                       const std::function<void(const Sample &)> & observe = {});

/// Checks the fields `duration` and `outlives_client`. A mode that ends with its goal may last 1 day and does
/// not outlive its client; one that does not end with its goal has the duration 0.
template <typename Goal>
Check & check_end_of_mode(Check & check, const Goal & goal, bool ends_with_goal)
{
  constexpr double max_duration = 86400.0;  // s
  return check.in_range("duration", goal.duration, 0.0, ends_with_goal ? max_duration : 0.0, "s")
      .that(!ends_with_goal || !goal.outlives_client,
            "outlives_client is true, but this mode ends with its goal: use the command that ends in _start");
}

}  // namespace ur_ros_rtde
