#include "force/compliance.hpp"

#include "wait_for_duration.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_duration = 86400.0;  // s
}  // namespace

Outcome end_mode_after(Run & run, double duration, Mode & mode,
                       const std::function<void(const Sample &)> & observe)
{
  const auto stop_reason = wait_for_duration(run, duration, observe);
  // At a cancel, the driver ends the mode.
  if (!stop_reason) {
    mode.end();
  }
  return stop_reason && stop_reason->code != ErrorCode::canceled ? Outcome(*stop_reason) : Outcome::success();
}

Check & check_duration(Check & check, double duration, bool ends_with_goal)
{
  return check.in_range("duration", duration, 0.0, ends_with_goal ? max_duration : 0.0, "s");
}

}  // namespace ur_ros_rtde
