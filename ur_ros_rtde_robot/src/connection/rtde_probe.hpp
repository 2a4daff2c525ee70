#pragma once

#include <chrono>
#include <string>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// Asks whatever listens at the address' RTDE port for the protocol version and the controller's version,
/// within `limit` each. ur_rtde's constructors wait for such answers without a limit, and take anything for
/// an answer.
Expected<ControllerVersion> probe_rtde(const std::string & address, std::chrono::milliseconds limit);

/// The same for the dashboard server: does it greet as one?
Status probe_dashboard(const std::string & address, std::chrono::milliseconds limit);

}  // namespace ur_ros_rtde
