#include "ur_ros_rtde/detail/goals.hpp"

#include <algorithm>

#include "ur_ros_rtde/detail/thread_name.hpp"

namespace ur_ros_rtde {

Goals::Goals() : supervisor_([this](const std::stop_token & stop) { supervise_goals(stop); }) {}

Goals::~Goals()
{
  close(Error{ErrorCode::shutdown, "the node is shut down"}, std::chrono::milliseconds(0));
  threads_.clear();  // waits without a limit: objects that the threads use must outlive them
}

Status Goals::can_start(Work kind) const
{
  const std::lock_guard lock(mutex_);
  return can_start_locked(kind);
}

Status Goals::can_start_locked(Work kind) const
{
  if (closed_) {
    return failure(ErrorCode::shutdown, "the node is being shut down");
  }
  if (kind == Work::end) {
    return {};
  }
  const auto is_same = [kind](const Task & task) { return task.kind == kind; };
  const auto count = std::count_if(waiting_.begin(), waiting_.end(), is_same) +
                     std::count_if(running_.begin(), running_.end(), is_same);
  const std::size_t most = kind == Work::stop ? limit_of_stops : limit;
  if (static_cast<std::size_t>(count) >= most) {
    return failure(ErrorCode::busy,
                   std::to_string(most) + " goals are running, which is the limit: wait for one to end");
  }
  return {};
}

Status Goals::start(std::shared_ptr<Goal> goal, std::function<void()> work, Work kind)
{
  const std::lock_guard lock(mutex_);
  if (Status status = can_start_locked(kind); !status) {
    return status;
  }
  if (idle_ <= waiting_.size()) {
    try {
      threads_.emplace_back([this] { execute_tasks(); });
    } catch (const std::system_error & error) {
      return failure(ErrorCode::exception,
                     std::string("cannot start a thread for the goal: ") + error.what());
    }
  }
  waiting_.push_back({std::move(goal), std::move(work), kind});
  started_.notify_one();
  return {};
}

void Goals::end(const std::shared_ptr<Goal> & goal, std::function<void()> end)
{
  if (const Status started = start(goal, end, Work::end); !started) {
    end();
  }
}

void Goals::execute_tasks()
{
  std::unique_lock lock(mutex_);
  while (true) {
    ++idle_;
    started_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    --idle_;
    if (waiting_.empty()) {
      return;
    }
    running_.splice(running_.end(), waiting_, waiting_.begin());
    const auto task = std::prev(running_.end());
    lock.unlock();
    ending_.notify_one();
    name_thread("goal " + task->goal->name());
    task->work();
    task->work = nullptr;  // destroys captured objects before the goal counts as ended
    lock.lock();
    std::shared_ptr<Goal> goal = std::move(task->goal);
    running_.erase(task);
    ended_.notify_all();
    lock.unlock();
    goal.reset();
    name_thread("idle");
    lock.lock();
  }
}

void Goals::supervise(std::shared_ptr<Goal> goal)
{
  {
    const std::lock_guard lock(mutex_);
    endings_.push_back({std::move(goal), std::nullopt});
  }
  ending_.notify_one();
}

std::vector<std::shared_ptr<Goal>> Goals::running_goals_locked() const
{
  std::vector<std::shared_ptr<Goal>> goals;
  for (const Task & task : running_) {
    if (!task.goal->is_finished()) {
      goals.push_back(task.goal);
    }
  }
  return goals;
}

void Goals::supervise_goals(const std::stop_token & stop)
{
  constexpr std::chrono::milliseconds interval{20};
  std::unique_lock lock(mutex_);
  while (ending_.wait(lock, stop, [this] { return !endings_.empty() || !running_.empty(); })) {
    auto goals = running_goals_locked();
    lock.unlock();
    for (const auto & goal : goals) {
      if (const auto why = goal->ended_by_robot()) {
        goal->stop(*why);  // once: it remembers the first reason
      }
    }
    goals.clear();  // destroyed without the lock
    lock.lock();
    auto endings = std::exchange(endings_, {});
    lock.unlock();
    std::vector<Ending> left;
    for (Ending & ending : endings) {
      if (!has_ended(ending)) {
        left.push_back(std::move(ending));
      }
    }
    lock.lock();
    endings_.insert(endings_.end(), left.begin(), left.end());
    ending_.wait_for(lock, stop, interval, [] { return false; });
  }
}

bool Goals::has_ended(Ending & ending)
{
  if (ending.goal->is_finished()) {
    return true;
  }
  if (!ending.deadline && ending.goal->stopped()) {
    ending.deadline = Clock::now() + return_timeout;
  }
  if (!ending.deadline || Clock::now() <= *ending.deadline) {
    return false;
  }
  end(ending.goal, [goal = ending.goal] { goal->abandon(); });
  return true;
}

void Goals::end(const Error & why)
{
  std::vector<std::shared_ptr<Goal>> goals;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    for (const auto * tasks : {&waiting_, &running_}) {
      for (const Task & task : *tasks) {
        goals.push_back(task.goal);
      }
    }
  }
  started_.notify_all();
  for (const auto & goal : goals) {
    goal->stop(why);
  }
}

std::vector<std::string> Goals::close(const Error & why, std::chrono::milliseconds timeout)
{
  end(why);
  std::unique_lock lock(mutex_);
  ended_.wait_for(lock, timeout, [this] { return waiting_.empty() && running_.empty(); });
  std::vector<std::string> names;
  for (const auto * tasks : {&waiting_, &running_}) {
    for (const Task & task : *tasks) {
      if (task.kind != Work::end) {
        names.push_back(task.goal->name());
      }
    }
  }
  return names;
}

}  // namespace ur_ros_rtde
