#pragma once

#include <cstddef>

namespace ur_ros_rtde {

/// Each RTDE package begins with its total size as big-endian uint16 and its type as uint8 (UR, "Real-Time
/// Data Exchange (RTDE) Guide").
inline constexpr std::size_t rtde_header_size = 3;

}  // namespace ur_ros_rtde
