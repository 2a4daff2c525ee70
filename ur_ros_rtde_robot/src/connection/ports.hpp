#pragma once

#include <cstdint>

namespace ur_ros_rtde {

/// TCP ports of a UR controller to which this package connects (UR, "Overview of client interfaces").
inline constexpr std::uint16_t rtde_port = 30004;
inline constexpr std::uint16_t dashboard_port = 29999;
inline constexpr std::uint16_t primary_port = 30001;
inline constexpr std::uint16_t script_port = 30003;

}  // namespace ur_ros_rtde
