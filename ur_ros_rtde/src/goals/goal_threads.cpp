#include "ur_ros_rtde/detail/goal_threads.hpp"

namespace ur_ros_rtde {

GoalThreads::~GoalThreads()
{
  close(Error{ErrorCode::shutdown, "the node is shut down"}, std::chrono::milliseconds(0));
  threads_.clear();  // waits without a limit: objects that the threads use must outlive them
}

Status GoalThreads::can_start() const
{
  const std::lock_guard lock(mutex_);
  return can_start_locked();
}

Status GoalThreads::can_start_locked() const
{
  if (closed_) {
    return failure(ErrorCode::shutdown, "the node is being shut down");
  }
  if (waiting_.size() + running_.size() >= limit) {
    return failure(ErrorCode::busy,
                   std::to_string(limit) + " goals are running, which is the limit: wait for one to end");
  }
  return {};
}

Status GoalThreads::start(std::string name, std::shared_ptr<StopRequest> stop_request,
                          std::function<void()> work)
{
  const std::lock_guard lock(mutex_);
  if (Status status = can_start_locked(); !status) {
    return status;
  }
  if (idle_ <= waiting_.size()) {
    try {
      threads_.emplace_back([this] { execute_goals(); });
    } catch (const std::system_error & error) {
      return failure(ErrorCode::exception,
                     std::string("cannot start a thread for the goal: ") + error.what());
    }
  }
  waiting_.push_back({std::move(name), std::move(stop_request), std::move(work)});
  started_.notify_one();
  return {};
}

void GoalThreads::execute_goals()
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
    const auto goal = std::prev(running_.end());
    lock.unlock();
    goal->work();
    goal->work = nullptr;  // destroys captured objects before the goal counts as ended
    lock.lock();
    running_.erase(goal);
    ended_.notify_all();
  }
}

std::vector<std::string> GoalThreads::close(const StopReason & why, std::chrono::milliseconds wait_limit)
{
  std::unique_lock lock(mutex_);
  closed_ = true;
  started_.notify_all();
  for (const auto * goals : {&waiting_, &running_}) {
    for (const Goal & goal : *goals) {
      goal.stop_request->request(why);
    }
  }
  ended_.wait_for(lock, wait_limit, [this] { return waiting_.empty() && running_.empty(); });
  std::vector<std::string> names;
  for (const auto * goals : {&waiting_, &running_}) {
    for (const Goal & goal : *goals) {
      names.push_back(goal.name);
    }
  }
  return names;
}

}  // namespace ur_ros_rtde
