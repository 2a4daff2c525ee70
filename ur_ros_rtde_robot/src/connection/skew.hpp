#pragma once

#include <chrono>

namespace ur_ros_rtde {

/// Longest delay between separate connections to the controller, as those of RTDE and of the primary
/// interface, for events of the same control cycle.
constexpr std::chrono::milliseconds max_skew(100);

}  // namespace ur_ros_rtde
