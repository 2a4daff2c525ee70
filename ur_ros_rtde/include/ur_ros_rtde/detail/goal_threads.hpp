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

/// The threads that execute goals, one per goal. A thread whose goal has ended waits for the next goal:
/// waking it takes a fraction of the time that a new thread needs to run on a busy host. All are joined by
/// the destructor. Thread-safe.
class GoalThreads {
 public:
  /// Largest number of goals that run at the same time, and of threads.
  static constexpr std::size_t limit = 64;

  GoalThreads() = default;
  /// Calls close() and waits for all threads without a limit.
  ~GoalThreads();
  GoalThreads(const GoalThreads &) = delete;
  GoalThreads & operator=(const GoalThreads &) = delete;

  /// Success if start() can start another goal.
  Status can_start() const;
  /// Runs `work`, which must not throw, in a thread. `name` is used in messages: "move_l 3f0c12ab". Fails
  /// after close() and if `limit` goals are running.
  Status start(std::string name, std::shared_ptr<StopRequest> stop_request, std::function<void()> work);
  /// Asks all goals to stop, rejects new ones, and waits up to `limit`. Returns the names of those that still
  /// run.
  std::vector<std::string> close(const StopReason & why, std::chrono::milliseconds limit);

 private:
  struct Goal {
    std::string name;
    std::shared_ptr<StopRequest> stop_request;
    std::function<void()> work;
  };

  Status can_start_locked() const;
  void execute_goals();

  mutable std::mutex mutex_;
  std::condition_variable started_;
  std::condition_variable ended_;
  std::list<Goal> waiting_;  // for a thread
  std::list<Goal> running_;
  std::size_t idle_ = 0;  // threads that wait for a goal
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace ur_ros_rtde
