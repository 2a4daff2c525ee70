#include "force/compliance.hpp"

#include <fmt/format.h>

#include "wait_for_duration.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double max_duration = 86400.0;  // s
}  // namespace

void end_mode(Run & run, EndFunction end, const std::string & mode)
{
  check_result(((*run.control().hold()).*end)(), "end " + mode);
}

Outcome end_mode_after(Run & run, double duration, EndFunction end, const std::string & mode,
                       const std::function<void(const Sample &)> & observe)
{
  const auto stop_reason = wait_for_duration(run, duration, observe);
  // At a cancel, the driver ends the mode.
  if (!stop_reason) {
    end_mode(run, end, mode);
  }
  return stop_reason && stop_reason->code != ErrorCode::canceled ? Outcome(*stop_reason) : Outcome::success();
}

void check_modes_inactive(Run & run, std::uint32_t modes, const std::string & requested_mode)
{
  using Control = ur_rtde::RTDEControlInterface;
  const std::uint32_t active = run.control()->getStartedMotions() & modes;
  if (active == 0) {
    return;
  }
  const char * mode = (active & Control::MOTION_FREEDRIVE) != 0 ? "freedrive (end it: freedrive_stop)"
                      : (active & Control::MOTION_TEACH) != 0   ? "teach mode (end it: end_teach_mode)"
                                                                : "force mode (end it: force_mode_stop)";
  throw RobotError({ErrorCode::busy, fmt::format("no {} while the arm is in {}", requested_mode, mode)});
}

Check & check_duration(Check & check, double duration, bool ends_with_goal)
{
  return check.in_range("duration", duration, 0.0, ends_with_goal ? max_duration : 0.0, "s");
}

}  // namespace ur_ros_rtde
