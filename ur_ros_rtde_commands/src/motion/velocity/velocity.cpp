#include "motion/velocity/velocity.hpp"

#include <algorithm>

namespace ur_ros_rtde {
namespace {
/// s. Limits the wait if the controller's clock stands still.
constexpr double clock_reserve = 5.0;
}  // namespace

std::optional<StopReason> wait_with_progress(Run & run, double time)
{
  const double begin = run.state().controller_time;
  const auto time_is_over = [&] {
    run.progress(std::clamp((run.state().controller_time - begin) / time, 0.0, 1.0));
    return run.progress() >= 1.0;
  };
  const std::chrono::duration<double> limit(time + clock_reserve);
  return run.until(time_is_over, std::chrono::duration_cast<std::chrono::nanoseconds>(limit));
}

Outcome finish_velocity_motion(Run & run, double time, double deceleration)
{
  if (auto stop_reason = wait_with_progress(run, time)) {
    return *stop_reason;
  }
  run.control()->speedStop(deceleration);
  const auto stop_reason = run.until_standstill();
  return stop_reason ? Outcome(*stop_reason) : Outcome::success();
}

}  // namespace ur_ros_rtde
