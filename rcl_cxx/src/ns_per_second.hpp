#pragma once

#include <cstdint>

namespace rcl_cxx::detail {

/// ROS messages carry a time as seconds and nanoseconds, rcl as nanoseconds.
inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace rcl_cxx::detail
