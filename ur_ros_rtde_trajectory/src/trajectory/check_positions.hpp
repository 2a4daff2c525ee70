#pragma once

#include <string_view>

#include "ur_ros_rtde_trajectory/limits.hpp"

namespace ur_ros_rtde::trajectory {

/// Returns an error if a position is outside its limits. `field` names the positions in the message.
Status check_positions(std::string_view field, const Joints & positions, const Limits & limits);

}  // namespace ur_ros_rtde::trajectory
