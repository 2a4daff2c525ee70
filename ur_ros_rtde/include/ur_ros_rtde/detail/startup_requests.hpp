#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>

namespace ur_ros_rtde {

/// The requests that are under way to bring the arm into operation, so that another request can be sent after
/// them. Thread-safe.
class StartupRequests {
 public:
  /// The request is under way while the returned object exists, which must end before this one. Null if
  /// `may_begin` is false, which has to be so before wait_until_none() is called.
  std::shared_ptr<void> begin(const std::function<bool()> & may_begin);
  /// Whether one is under way, or has ended so recently that the samples may not show its effect yet.
  bool may_take_effect() const;
  /// False if a request is still under way after `timeout`.
  bool wait_until_none(std::chrono::milliseconds timeout);

 private:
  void end();

  mutable std::mutex mutex_;
  std::condition_variable ended_;
  unsigned under_way_ = 0;
  std::chrono::steady_clock::time_point last_end_{};
};

}  // namespace ur_ros_rtde
