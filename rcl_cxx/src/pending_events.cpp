#include "pending_events.hpp"

#include <algorithm>
#include <iterator>

#include "timer_impl.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
void PendingEvents::push(Event event)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->push(std::move(event));
  } else {
    waiting_.push_back(std::move(event));
  }
}

void PendingEvents::schedule(TimedEvent event)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->schedule(std::move(event));
  }
}

void PendingEvents::add_timer(std::weak_ptr<TimerImpl> timer)
{
  const std::lock_guard lock(mutex_);
  std::erase_if(timers_, [](const auto & other) { return other.expired(); });
  timers_.push_back(std::move(timer));
}

bool PendingEvents::attach(std::shared_ptr<EventQueue> queue)
{
  std::vector<std::weak_ptr<TimerImpl>> timers;
  {
    const std::lock_guard lock(mutex_);
    if (queue_) {
      return false;
    }
    queue_ = std::move(queue);
    for (Event & event : waiting_) {
      queue_->push(std::move(event));
    }
    waiting_.clear();
    timers = timers_;
  }
  for (const auto & weak : timers) {
    if (const auto timer = weak.lock()) {
      timer->arm();
    }
  }
  return true;
}

void PendingEvents::detach(EventQueue & queue)
{
  std::vector<std::weak_ptr<TimerImpl>> timers;
  {
    const std::lock_guard lock(mutex_);
    if (queue_.get() != &queue) {
      return;
    }
    queue_.reset();
    timers = timers_;
  }
  // Not under the lock: the last references to entities may end in there, and theirs to the middleware.
  std::vector<Event> events = queue.extract(*this);
  {
    const std::lock_guard lock(mutex_);
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(events));
    waiting_.swap(events);
  }
  for (const auto & weak : timers) {
    if (const auto timer = weak.lock()) {
      timer->disarm();
    }
  }
}

std::shared_ptr<EventQueue> PendingEvents::queue() const
{
  const std::lock_guard lock(mutex_);
  return queue_;
}

}  // namespace rcl_cxx::detail
