#pragma once

#include <optional>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// The state of the robot (safety, power, brakes) that prevents motion, with the remedy. Empty if motion is
/// possible.
std::optional<Error> motion_blocker(const Sample & sample);

}  // namespace ur_ros_rtde
