#include "events/event_queue.hpp"

#include <algorithm>
#include <utility>

namespace rcl_cxx::detail {
void EventQueue::push(Event event)
{
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
  }
  wake_.notify_one();
}

void EventQueue::add_timer(std::shared_ptr<TimerSchedule> timer)
{
  {
    const std::lock_guard lock(mutex_);
    timers_.push_back(std::move(timer));
  }
  wake_.notify_one();
}

void EventQueue::wake()
{
  {
    const std::lock_guard lock(mutex_);  // next() may be between reading the timers and waiting
  }
  wake_.notify_one();
}

EventQueue::Clock::time_point EventQueue::push_due_timers()
{
  // The timer holds the other reference.
  std::erase_if(timers_, [](const auto & timer) { return timer.use_count() == 1; });
  const Clock::time_point now = Clock::now();
  Clock::time_point next = TimerSchedule::kNever;
  for (const auto & timer : timers_) {
    Clock::time_point due = timer->due;
    if (due <= now && timer->due.compare_exchange_strong(due, TimerSchedule::kNever)) {
      events_.push_back({timer->timer, 0, {}});
    } else {
      next = std::min(next, due);
    }
  }
  return next;
}

std::optional<Event> EventQueue::next(Clock::time_point deadline)
{
  std::unique_lock lock(mutex_);
  while (!canceled_ && !ended_) {
    const Clock::time_point until = std::min(deadline, push_due_timers());
    if (!events_.empty()) {
      Event event = std::move(events_.front());
      events_.pop_front();
      return event;
    }
    if (Clock::now() >= deadline) {
      break;
    }
    if (until == Clock::time_point::max()) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, until);
    }
  }
  return std::nullopt;
}

void EventQueue::cancel()
{
  {
    const std::lock_guard lock(mutex_);
    canceled_ = true;
  }
  wake_.notify_all();
}

bool EventQueue::take_cancel()
{
  const std::lock_guard lock(mutex_);
  return std::exchange(canceled_, false);
}

void EventQueue::end()
{
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
}

bool EventQueue::is_canceled_or_ended() const
{
  const std::lock_guard lock(mutex_);
  return canceled_ || ended_;
}

const EventQueue *& EventQueue::current() noexcept
{
  thread_local const EventQueue * queue = nullptr;
  return queue;
}

void PendingEvents::push(Event event)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->push(std::move(event));
  } else {
    events_.push_back(std::move(event));
  }
}

void PendingEvents::add_timer(std::shared_ptr<TimerSchedule> timer)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->add_timer(std::move(timer));
  } else {
    timers_.push_back(std::move(timer));
  }
}

void PendingEvents::wake()
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    queue_->wake();
  }
}

bool PendingEvents::attach(std::shared_ptr<EventQueue> queue)
{
  const std::lock_guard lock(mutex_);
  if (queue_) {
    return false;
  }
  queue_ = std::move(queue);
  for (Event & event : events_) {
    queue_->push(std::move(event));
  }
  for (auto & timer : timers_) {
    queue_->add_timer(std::move(timer));
  }
  events_.clear();
  timers_.clear();
  return true;
}

bool PendingEvents::in_own_callback() const
{
  const std::lock_guard lock(mutex_);
  return queue_ && queue_.get() == EventQueue::current();
}

}  // namespace rcl_cxx::detail
