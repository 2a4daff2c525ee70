#include "force/compliance.hpp"

#include "wait_for_duration.hpp"

namespace ur_ros_rtde {

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

}  // namespace ur_ros_rtde
