#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <cstdint>

namespace rcl_cxx::detail {
inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

inline builtin_interfaces::msg::Time to_time(std::int64_t nanoseconds)
{
  builtin_interfaces::msg::Time time;
  time.sec = static_cast<std::int32_t>(nanoseconds / kNsPerSecond);
  time.nanosec = static_cast<std::uint32_t>(nanoseconds % kNsPerSecond);
  return time;
}

/// `Time` is the C++ or the C message.
template <typename Time>
std::int64_t to_ns(const Time & time)
{
  return time.sec * kNsPerSecond + time.nanosec;
}

}  // namespace rcl_cxx::detail
