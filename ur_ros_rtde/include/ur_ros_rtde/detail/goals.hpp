#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ur_ros_rtde/detail/goal.hpp"

namespace ur_ros_rtde {

/// The threads of the goals of a node, one per goal, and the end of goals that the robot has ended, or whose
/// command does not return. A thread whose goal has ended waits for the next goal: waking it takes a fraction
/// of the time that a new thread needs to run on a busy host. All are joined by the destructor. Thread-safe.
class Goals {
 public:
  /// Largest number of goals that run at the same time. Stops have threads of their own beside these.
  static constexpr std::size_t limit = 64;
  static constexpr std::size_t limit_of_stops = 16;
  /// From the standstill after Goal::stop() to the result, if the command does not return.
  static constexpr std::chrono::milliseconds return_timeout{500};

  Goals();
  /// Calls close() and waits for all threads without a limit.
  ~Goals();
  Goals(const Goals &) = delete;
  Goals & operator=(const Goals &) = delete;

  /// Success if start() can start another goal.
  Status can_start() const;
  /// Runs `work`, which must not throw, in a thread for `goal`. Fails after close() and if `limit` goals are
  /// running.
  Status start(std::shared_ptr<Goal> goal, std::function<void()> work);
  /// The same for a goal that stops the arm: succeeds even if `limit` other goals are running.
  Status start_stop(std::shared_ptr<Goal> goal, std::function<void()> work);
  /// Abandons `goal`, which was told to end, if it has no result `return_timeout` after the arm is at rest.
  void supervise(std::shared_ptr<Goal> goal);
  /// Tells all goals to end, and rejects new ones. Returns at once.
  void end(const Error & why);
  /// The same, and waits for them up to `timeout`. Returns the names of those whose thread still runs.
  std::vector<std::string> close(const Error & why, std::chrono::milliseconds timeout);

 private:
  using Clock = std::chrono::steady_clock;
  struct Task {
    std::shared_ptr<Goal> goal;
    std::function<void()> work;
  };
  struct Ending {
    std::shared_ptr<Goal> goal;
    std::optional<Clock::time_point> deadline;  ///< once the arm is at rest
  };

  Status can_start_locked(std::size_t most) const;
  Status start_locked(std::shared_ptr<Goal> goal, std::function<void()> work);
  void execute_tasks();
  void supervise_goals(const std::stop_token & stop);
  /// In a thread of its own: what a plugin writes into the result may hang, as its command does.
  bool abandon_if_late(Ending & ending);
  std::vector<std::shared_ptr<Goal>> running_goals_locked() const;

  mutable std::mutex mutex_;
  std::condition_variable started_;
  std::condition_variable ended_;
  std::condition_variable_any ending_;
  std::list<Task> waiting_;  // for a thread
  std::list<Task> running_;
  std::vector<Ending> endings_;
  std::size_t idle_ = 0;  // threads that wait for a task
  bool closed_ = false;
  std::vector<std::jthread> threads_;
  std::jthread supervisor_;
};

}  // namespace ur_ros_rtde
