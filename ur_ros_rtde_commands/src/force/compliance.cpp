#include "force/compliance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_ros_rtde {
namespace {
constexpr double max_duration = 86400.0;  // s
constexpr std::chrono::hours unlimited{24 * 365};
constexpr double clock_reserve = 5.0;  // s, for a controller whose clock is slower than this one
}  // namespace

std::optional<StopReason> wait_for_duration(Run & run, double duration,
                                            const std::function<void(const Sample &)> & observe)
{
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

std::optional<StopReason> wait_for_duration_or_cancel(Run & run, double duration,
                                                      const std::function<void(const Sample &)> & observe)
{
  auto stop_reason = wait_for_duration(run, duration, observe);
  return stop_reason && stop_reason->code == ErrorCode::canceled ? std::nullopt : stop_reason;
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
