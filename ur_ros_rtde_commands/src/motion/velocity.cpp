#include "velocity.hpp"

#include <algorithm>

namespace ur_ros_rtde {
namespace {
/// s: a controller's clock that stands still ends the wait.
constexpr double patience = 5.0;
}  // namespace

std::optional<StopReason> pass_time(Run & run, double time)
{
  const double begin = run.state().controller_time;
  const auto time_is_over = [&] {
    run.progress(std::clamp((run.state().controller_time - begin) / time, 0.0, 1.0));
    return run.progress() >= 1.0;
  };
  const std::chrono::duration<double> limit(time + patience);
  return run.until(time_is_over, std::chrono::duration_cast<std::chrono::nanoseconds>(limit));
}

Outcome hold_velocity(Run & run, double time, double deceleration)
{
  if (auto why = pass_time(run, time)) {
    return *why;
  }
  run.control()->speedStop(deceleration);
  const auto why = run.until_standstill();
  return why ? Outcome(*why) : Outcome::success();
}

}  // namespace ur_ros_rtde
