#pragma once

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Checks the fields `acceleration`, `time` and `deceleration` of a goal of speed_j or speed_l.
template <typename Goal>
Check & check_velocity_motion(Check & check, const Goal & goal, const SpeedLimits & limits)
{
  return check.above_zero("acceleration", goal.acceleration, limits.acceleration, limits.acceleration_unit)
      .in_range("time", goal.time, 0.01, 3600.0, "s")
      .in_range("deceleration", goal.deceleration, min_deceleration, limits.acceleration,
                limits.acceleration_unit);
}

/// After speedJ or speedL: waits for `time` (s). When the command returns, the driver decelerates the arm.
Outcome wait_for_end(Run & run, double time);

}  // namespace ur_ros_rtde
