#include "motion/velocity/velocity.hpp"

#include "wait_for_duration.hpp"

namespace ur_ros_rtde {

Outcome wait_for_end(Run & run, double time)
{
  const auto stop_reason = wait_for_duration(run, time);
  return stop_reason ? Outcome(*stop_reason) : Outcome::success();
}

}  // namespace ur_ros_rtde
