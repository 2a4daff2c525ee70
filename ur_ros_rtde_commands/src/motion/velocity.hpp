#pragma once

#include "ur_ros_rtde/run.hpp"

namespace ur_ros_rtde {

/// Passes `time`, s of the controller's clock, with progress, while the arm moves at a velocity.
[[nodiscard]] std::optional<StopReason> pass_time(Run & run, double time);

/// After speedJ or speedL: passes `time`, then decelerates to standstill (rad/s^2 or m/s^2).
[[nodiscard]] Outcome hold_velocity(Run & run, double time, double deceleration);

}  // namespace ur_ros_rtde
