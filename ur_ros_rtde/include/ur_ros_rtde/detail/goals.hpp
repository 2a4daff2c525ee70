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
  /// Largest number of goals that run at the same time.
  static constexpr std::size_t limit = 64;
  /// The same for goals that stop the arm, beside the others.
  static constexpr std::size_t limit_of_stops = 16;
  /// From the standstill after Goal::stop() to the result, if the command does not return.
  static constexpr std::chrono::milliseconds return_timeout{500};

  Goals();
  /// Calls close() and waits for all threads without a limit.
  ~Goals();
  Goals(const Goals &) = delete;
  Goals & operator=(const Goals &) = delete;

  /// What a thread does for its goal: what the goal does, what a stop does, or only the end of a goal.
  enum class Work { goal, stop, end };

  /// Success if start() can start another goal.
  Status can_start(Work kind = Work::goal) const;
  /// Runs `work`, which must not throw, in a thread for `goal`. Fails after close(), if the limit of that
  /// kind is reached, and if there is no thread. The ends of goals have no limit.
  Status start(std::shared_ptr<Goal> goal, std::function<void()> work, Work kind = Work::goal);
  /// Ends `goal`, whose command does not run, with `end` in a thread of its own, because a plugin that writes
  /// into the result may hang; without a thread, in this one.
  void end(const std::shared_ptr<Goal> & goal, std::function<void()> end);
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
    Work kind;
  };
  struct Ending {
    std::shared_ptr<Goal> goal;
    std::optional<Clock::time_point> deadline;  ///< once the arm is at rest
  };

  Status can_start_locked(Work kind) const;
  void execute_tasks();
  void supervise_goals(const std::stop_token & stop);
  /// Returns true if the goal has ended, or was abandoned.
  bool has_ended(Ending & ending);
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
