#include "motion/velocity/velocity.hpp"

#include "wait_for_duration.hpp"

namespace ur_ros_rtde {

Outcome finish_velocity_motion(Run & run, double time, double deceleration)
{
  if (auto stop_reason = wait_for_duration(run, time)) {
    return *stop_reason;
  }
  run.control()->speedStop(deceleration);
  const auto stop_reason = run.until_standstill();
  return stop_reason ? Outcome(*stop_reason) : Outcome::success();
}

}  // namespace ur_ros_rtde
