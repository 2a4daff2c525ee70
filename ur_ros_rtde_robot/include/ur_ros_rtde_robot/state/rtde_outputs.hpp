#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Whether some controller has an RTDE output of this name (UR, "Real-Time Data Exchange (RTDE) Guide",
/// "Robot controller outputs"). Which of them a controller has depends on its version: it says so itself.
bool is_rtde_output(std::string_view name);

/// The first of `names` that is none, or is there twice, as an error that names it.
Status check_rtde_outputs(const std::vector<std::string> & names);

}  // namespace ur_ros_rtde
