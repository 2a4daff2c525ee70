#pragma once

#include <optional>

#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// What of the robot itself (safety, power, brakes) keeps the arm from moving, with what to do about it; none
/// when nothing does.
std::optional<Error> robot_condition(const Sample & sample);

}  // namespace ur_ros_rtde
