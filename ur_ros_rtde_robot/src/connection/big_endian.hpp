#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ur_ros_rtde {

/// Decodes an unsigned integer of up to 8 bytes. RTDE and the primary interface send numbers in big-endian
/// byte order.
inline std::uint64_t big_endian(std::span<const std::byte> bytes)
{
  std::uint64_t value = 0;
  for (const std::byte byte : bytes) {
    value = value << 8U | std::to_integer<std::uint64_t>(byte);
  }
  return value;
}

}  // namespace ur_ros_rtde
