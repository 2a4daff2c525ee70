#pragma once

#include <rcl/time.h>

#include <cstdint>
#include <mutex>
#include <optional>

namespace rcl_cxx::detail {
/// ROS time: the system clock, unless overridden (use_sim_time). Thread-safe.
class RosClock {
 public:
  RosClock();
  ~RosClock();
  RosClock(const RosClock &) = delete;
  RosClock & operator=(const RosClock &) = delete;

  /// Nanoseconds since the epoch.
  std::int64_t now_ns() const;
  /// Sets the time; without a value, returns to the system clock.
  void override_with(std::optional<std::int64_t> now_ns);

  rcl_clock_t * handle() noexcept { return &clock_; }
  /// To hold while rcl adds a timer to this clock, or removes it: the time may jump in another thread.
  std::unique_lock<std::mutex> lock() const { return std::unique_lock(mutex_); }

 private:
  mutable std::mutex mutex_;  // rcl's functions on one clock are not thread-safe
  mutable rcl_clock_t clock_;
};

}  // namespace rcl_cxx::detail
