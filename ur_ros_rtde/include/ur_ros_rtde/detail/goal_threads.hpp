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

/// The threads that execute goals, one per goal. All are joined by the destructor. Thread-safe.
class GoalThreads {
 public:
  /// Largest number of threads.
  static constexpr std::size_t limit = 64;

  GoalThreads() = default;
  /// Calls close() and waits for all threads without a limit.
  ~GoalThreads();
  GoalThreads(const GoalThreads &) = delete;
  GoalThreads & operator=(const GoalThreads &) = delete;

  /// Success if start() can start another thread.
  Status can_start() const;
  /// Runs `work`, which must not throw, in a thread. `name` is used in messages: "move_l 3f0c12ab". Fails
  /// after close() and if `limit` threads are running.
  Status start(std::string name, std::shared_ptr<StopRequest> stop_request, std::function<void()> work);
  /// Asks all goals to stop, rejects new ones, and waits up to `limit`. Returns the names of those that still
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
