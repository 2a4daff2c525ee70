#pragma once

#include <functional>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/mode.hpp"

namespace ur_ros_rtde {

/// Waits for the end of a mode that lasts as long as its goal, and ends it: after `duration` (see
/// wait_for_duration()), or at a cancel, which counts as success.
Outcome end_mode_after(Run & run, double duration, Mode & mode,
                       const std::function<void(const Sample &)> & observe = {});

/// Checks the field `duration`: 0 s to 1 day if the mode ends with its goal, otherwise exactly 0.
Check & check_duration(Check & check, double duration, bool ends_with_goal);

}  // namespace ur_ros_rtde
