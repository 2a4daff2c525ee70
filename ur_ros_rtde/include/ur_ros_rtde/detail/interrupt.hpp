#pragma once

#include <mutex>
#include <optional>
#include <stop_token>

#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// Asks a goal that runs in another thread to end, once: the first reason counts. Thread-safe.
class Interrupt {
 public:
  void request(Interruption why)
  {
    {
      const std::lock_guard lock(mutex_);
      if (why_) {
        return;
      }
      why_ = std::move(why);
    }
    source_.request_stop();
  }

  std::optional<Interruption> requested() const
  {
    const std::lock_guard lock(mutex_);
    return why_;
  }

  /// Wakes waits as soon as an end is requested.
  std::stop_token token() const { return source_.get_token(); }

 private:
  mutable std::mutex mutex_;
  std::optional<Interruption> why_;
  std::stop_source source_;
};

}  // namespace ur_ros_rtde
