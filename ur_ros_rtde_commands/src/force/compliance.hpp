#pragma once

#include <functional>
#include <string>
#include <vector>

#include "must_do.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Until `duration` s of the controller's time are over; with 0 only what ends the goal ends it. `look` sees
/// every package.
std::optional<StopReason> until_over(Run & run, double duration,
                                     const std::function<void(const Sample &)> & look = {});
/// The same for what lasts as long as its goal: a cancel is its end, not a failure.
std::optional<StopReason> last_for(Run & run, double duration,
                                   const std::function<void(const Sample &)> & look = {});

/// Throws RobotError (busy) when the arm is in one of ur_rtde's `modes` (RTDEControlInterface::MOTION_…):
/// `what` cannot be had besides.
void must_not_be_in(Run & run, std::uint32_t modes, const std::string & what);

/// Of a goal that may last; of one that switches a mode on, 0.
Check & duration_of(Check & check, double duration, bool goal_ends_it);

/// As ur_rtde has it: 1 for true.
template <typename Flags>
std::vector<int> to_ints(const Flags & flags)
{
  return {flags.begin(), flags.end()};
}

}  // namespace ur_ros_rtde
