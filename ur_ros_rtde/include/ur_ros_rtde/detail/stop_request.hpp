#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <stop_token>

#include "ur_ros_rtde/outcome.hpp"

namespace ur_ros_rtde {

/// A request to stop a goal or a teleoperation topic that runs in another thread. It is made once: the first
/// reason is kept. Thread-safe.
class StopRequest {
 public:
  /// True for the first request.
  bool request(StopReason reason)
  {
    {
      const std::lock_guard lock(mutex_);
      if (reason_) {
        return false;
      }
      reason_ = std::move(reason);
    }
    source_.request_stop();
    return true;
  }

  /// Empty: no stop was requested.
  std::optional<StopReason> reason() const
  {
    const std::lock_guard lock(mutex_);
    return reason_;
  }

  /// The result was sent without the goal's thread, which must no longer act on the robot.
  void abandon() { is_abandoned_ = true; }
  bool is_abandoned() const { return is_abandoned_; }

  /// Wakes waits when a stop is requested.
  std::stop_token token() const { return source_.get_token(); }

 private:
  mutable std::mutex mutex_;
  std::optional<StopReason> reason_;
  std::atomic<bool> is_abandoned_ = false;
  std::stop_source source_;
};

}  // namespace ur_ros_rtde
