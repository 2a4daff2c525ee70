#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/digital_output.hpp"
#include "ur_ros_rtde/tool_settings.hpp"

namespace ur_ros_rtde {

/// Calls `set` and waits until the robot reports that analog output `pin` is `value`, in A or V, within
/// `tolerance`.
Outcome set_analog_output(Run & run, unsigned pin, double value, double tolerance, const char * unit,
                          const std::function<bool(ur_rtde::RTDEIOInterface &)> & set);

/// The failure (link_lost) of a value that ur_rtde could not send.
Outcome send_failure();

/// Checks the mass (kg) and the center of gravity (m) of a payload.
Check & check_payload(Check & check, double mass, const geometry_msgs::msg::Vector3 & center_of_gravity);
Vector3 to_vector(const geometry_msgs::msg::Vector3 & vector);

}  // namespace ur_ros_rtde
