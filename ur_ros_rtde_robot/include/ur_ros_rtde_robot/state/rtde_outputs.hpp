#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// True if there is an RTDE output with this name (UR, "Real-Time Data Exchange (RTDE) Guide", "Robot
/// controller outputs"). Older controller versions lack some of them.
bool is_rtde_output(std::string_view name);

/// invalid_goal, naming the first of `names` that is unknown or occurs twice.
Status check_rtde_outputs(const std::vector<std::string> & names);

}  // namespace ur_ros_rtde
