#include "force/compliance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_ros_rtde {
namespace {
constexpr double longest = 86400.0;               // s: a day
constexpr std::chrono::hours for_ever{24 * 365};  // s
constexpr double patience = 5.0;                  // s, with a controller whose time goes slowly
}  // namespace

std::optional<StopReason> until_over(Run & run, double duration,
                                     const std::function<void(const Sample &)> & look)
{
  const double begin = run.state().controller_time;
  const bool ends = duration > 0.0;
  const auto over = [&] {
    const Sample now = run.state();
    const double since = now.controller_time - begin;
    run.progress(ends ? std::clamp(since / duration, 0.0, 1.0) : 0.0);
    if (look) {
      look(now);
    }
    return ends && since >= duration;
  };
  const std::chrono::duration<double> limit(duration + patience);
  return run.until(over, ends ? std::chrono::duration_cast<std::chrono::nanoseconds>(limit) : for_ever);
}

std::optional<StopReason> last_for(Run & run, double duration,
                                   const std::function<void(const Sample &)> & look)
{
  auto why = until_over(run, duration, look);
  return why && why->code == ErrorCode::canceled ? std::nullopt : why;
}

void must_not_be_in(Run & run, std::uint32_t modes, const std::string & what)
{
  using Control = ur_rtde::RTDEControlInterface;
  const std::uint32_t in = run.control()->getStartedMotions() & modes;
  if (in == 0) {
    return;
  }
  const char * mode = (in & Control::MOTION_FREEDRIVE) != 0 ? "freedrive (end it: freedrive_stop)"
                      : (in & Control::MOTION_TEACH) != 0   ? "teach mode (end it: end_teach_mode)"
                                                            : "force mode (end it: force_mode_stop)";
  throw RobotError({ErrorCode::busy, fmt::format("no {} while the arm is in {}", what, mode)});
}

Check & duration_of(Check & check, double duration, bool goal_ends_it)
{
  return check.in_range("duration", duration, 0.0, goal_ends_it ? longest : 0.0, "s");
}

}  // namespace ur_ros_rtde
