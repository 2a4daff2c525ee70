#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ur_ros_rtde/detail/stop_request.hpp"

namespace ur_ros_rtde {

/// The threads that carry out goals: one each, all joined before this object is gone. Thread-safe.
class GoalThreads {
 public:
  /// More goals at a time than any client can mean.
  static constexpr std::size_t limit = 64;

  GoalThreads() = default;
  /// Ends what still runs, as close() does, however long that takes.
  ~GoalThreads();
  GoalThreads(const GoalThreads &) = delete;
  GoalThreads & operator=(const GoalThreads &) = delete;

  /// Whether start() would take another one.
  Status can_start() const;
  /// Runs `work`, which must not throw, in a thread. `name` is for messages: "move_l 3f0c12ab". Refused after
  /// close() and beyond the limit.
  Status start(std::string name, std::shared_ptr<StopRequest> stop_request, std::function<void()> work);
  /// Asks all to end, takes no more, and waits up to `limit` for them. Returns the names of those that still
  /// run.
  std::vector<std::string> close(const StopReason & why, std::chrono::milliseconds limit);

 private:
  struct Entry {
    std::string name;
    std::shared_ptr<StopRequest> stop_request;
    std::jthread thread;
    bool done = false;
  };

  Status can_start_locked() const;
  void join_finished(std::unique_lock<std::mutex> & lock);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Entry> entries_;
  bool closed_ = false;
};

}  // namespace ur_ros_rtde
