#include "ur_ros_rtde/detail/goal_threads.hpp"

#include <algorithm>

namespace ur_ros_rtde {

GoalThreads::~GoalThreads()
{
  close(Error{ErrorCode::shutdown, "the node is shut down"}, std::chrono::milliseconds(0));
  // Waits for the remaining threads without a limit: objects that they use must outlive them.
  std::list<Entry> entries;
  {
    const std::lock_guard lock(mutex_);
    entries.swap(entries_);
  }
  for (Entry & entry : entries) {
    entry.thread.join();
  }
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
  const auto running =
      std::count_if(entries_.begin(), entries_.end(), [](const Entry & e) { return !e.done; });
  if (static_cast<std::size_t>(running) >= limit) {
    return failure(ErrorCode::busy,
                   std::to_string(limit) + " goals are running, which is the limit: wait for one to end");
  }
  return {};
}

Status GoalThreads::start(std::string name, std::shared_ptr<StopRequest> stop_request,
                          std::function<void()> work)
{
  std::unique_lock lock(mutex_);
  join_finished(lock);  // before the check: close() may be called while it joins
  if (Status status = can_start_locked(); !status) {
    return status;
  }
  Entry & entry = entries_.emplace_back();
  entry.name = std::move(name);
  entry.stop_request = std::move(stop_request);
  try {
    entry.thread = std::jthread([this, &entry, work = std::move(work)]() mutable {
      work();
      work = nullptr;  // destroys captured objects before the thread counts as done
      const std::lock_guard done_lock(mutex_);
      entry.done = true;
      changed_.notify_all();
    });
  } catch (const std::system_error & error) {
    entries_.pop_back();
    return failure(ErrorCode::exception, std::string("cannot start a thread for the goal: ") + error.what());
  }
  return {};
}

std::vector<std::string> GoalThreads::close(const StopReason & why, std::chrono::milliseconds wait_limit)
{
  std::unique_lock lock(mutex_);
  closed_ = true;
  for (const Entry & entry : entries_) {
    entry.stop_request->request(why);
  }
  changed_.wait_for(lock, wait_limit, [this] {
    return std::all_of(entries_.begin(), entries_.end(), [](const Entry & entry) { return entry.done; });
  });
  join_finished(lock);
  std::vector<std::string> names;
  for (const Entry & entry : entries_) {
    names.push_back(entry.name);
  }
  return names;
}

void GoalThreads::join_finished(std::unique_lock<std::mutex> & lock)
{
  std::list<Entry> finished;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    if (entry->done) {
      finished.splice(finished.end(), entries_, entry);
    }
    entry = next;
  }
  lock.unlock();  // the end of their work locks it
  finished.clear();
  lock.lock();
}

}  // namespace ur_ros_rtde
