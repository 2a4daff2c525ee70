#pragma once

#include <functional>
#include <string>
#include <vector>

#include "check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// A function of ur_rtde that ends a mode.
using EndFunction = bool (ur_rtde::RTDEControlInterface::*)();
void end_mode(Run & run, EndFunction end, const std::string & mode);
/// Waits for the end of a mode that lasts as long as its goal, and ends it: after `duration` (see
/// wait_for_duration()), or at a cancel, which counts as success.
Outcome end_mode_after(Run & run, double duration, EndFunction end, const std::string & mode,
                       const std::function<void(const Sample &)> & observe = {});

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
