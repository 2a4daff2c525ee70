#pragma once

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Waits for `time` (s of the controller's clock) while the arm moves at a velocity, and updates the
/// progress.
[[nodiscard]] std::optional<StopReason> wait_with_progress(Run & run, double time);

/// After speedJ or speedL: waits for `time` (s), then decelerates to standstill (rad/s^2 or m/s^2).
[[nodiscard]] Outcome finish_velocity_motion(Run & run, double time, double deceleration);

}  // namespace ur_ros_rtde
