#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Waits for `duration` (s of the controller's clock), or until the goal has to stop if it is 0. Calls
/// `observe` with every sample.
std::optional<StopReason> wait_for_duration(Run & run, double duration,
                                            const std::function<void(const Sample &)> & observe = {});
/// The same for a mode that lasts as long as its goal: a cancel ends the wait successfully.
std::optional<StopReason> wait_for_duration_or_cancel(
    Run & run, double duration, const std::function<void(const Sample &)> & observe = {});

/// Throws RobotError (busy) if one of ur_rtde's `modes` (RTDEControlInterface::MOTION_…) is active, which
/// excludes `requested_mode`.
void check_modes_inactive(Run & run, std::uint32_t modes, const std::string & requested_mode);

/// Checks the field `duration`: 0 s to 1 day if the mode ends with its goal, otherwise exactly 0.
Check & check_duration(Check & check, double duration, bool ends_with_goal);

/// Converts flags to the format of ur_rtde: 1 for true.
template <typename Flags>
std::vector<int> to_int_flags(const Flags & flags)
{
  return {flags.begin(), flags.end()};
}

}  // namespace ur_ros_rtde
