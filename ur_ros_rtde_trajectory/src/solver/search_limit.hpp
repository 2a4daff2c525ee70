#pragma once

#include <chrono>
#include <stop_token>

namespace ur_ros_rtde::trajectory {

/// When the search for a faster motion has to end. What has been found by then keeps the limits.
struct SearchLimit {
  std::stop_token stop;
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();

  bool is_reached() const { return stop.stop_requested() || std::chrono::steady_clock::now() >= deadline; }
};

}  // namespace ur_ros_rtde::trajectory
