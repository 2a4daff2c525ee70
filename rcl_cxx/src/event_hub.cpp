#include "event_hub.hpp"

#include <algorithm>
#include <iterator>

#include "entity.hpp"
#include "timer_core.hpp"

namespace rcl_cxx::detail {
void EventHub::push(Event event)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->push(std::move(event));
  } else {
    waiting_.push_back(std::move(event));
  }
}

void EventHub::schedule(TimedEvent event)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->schedule(std::move(event));
  }
}

void EventHub::add_timer(std::weak_ptr<TimerCore> timer)
{
  const std::lock_guard lock(mutex_);
  std::erase_if(timers_, [](const auto & other) { return other.expired(); });
  timers_.push_back(std::move(timer));
}

bool EventHub::attach(std::shared_ptr<EventQueue> queue)
{
  std::vector<std::weak_ptr<TimerCore>> timers;
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

void EventHub::detach(EventQueue & queue)
{
  std::vector<std::weak_ptr<TimerCore>> timers;
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

std::shared_ptr<EventQueue> EventHub::queue() const
{
  const std::lock_guard lock(mutex_);
  return queue_;
}

}  // namespace rcl_cxx::detail
