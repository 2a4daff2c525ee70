#include "event_queue.hpp"

#include <algorithm>
#include <utility>

#include "node_impl.hpp"
#include "pending_events.hpp"
#include "timer_impl.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
namespace {
bool later(const TimedEvent & a, const TimedEvent & b)
{
  return a.due > b.due;
}
}  // namespace

void EventQueue::push(Event event)
{
  {
    const std::lock_guard lock(mutex_);
    events_.push_back(std::move(event));
  }
  wake_.notify_one();
}

void EventQueue::schedule(TimedEvent event)
{
  bool earliest = false;
  {
    const std::lock_guard lock(mutex_);
    if (timers_.size() >= timers_to_clean_) {
      forget_dead_timers();
    }
    earliest = timers_.empty() || event.due < timers_.front().due;
    timers_.push_back(std::move(event));
    std::push_heap(timers_.begin(), timers_.end(), &later);
  }
  if (earliest) {
    wake_.notify_one();
  }
}

void EventQueue::forget_dead_timers()
{
  // A timer that is reset often leaves an entry each time, up to its old due time.
  std::erase_if(timers_, [](const TimedEvent & event) { return event.is_void(); });
  std::make_heap(timers_.begin(), timers_.end(), &later);
  timers_to_clean_ = std::max<std::size_t>(64, 2 * timers_.size());
}

std::optional<Event> EventQueue::next(Clock::time_point deadline)
{
  std::unique_lock lock(mutex_);
  while (!stop_ && !ended_) {
    const Clock::time_point now = Clock::now();
    const bool timers_turn = served_ == events_.size() || !timer_had_its_turn_;
    if (timers_turn) {
      if (auto event = pop_due_timer(now)) {
        timer_had_its_turn_ = true;
        return event;
      }
    }
    timer_had_its_turn_ = false;
    if (auto event = pop_event()) {
      return event;
    }
    if (now >= deadline) {
      break;
    }
    const Clock::time_point until = timers_.empty() ? deadline : std::min(deadline, timers_.front().due);
    if (until == Clock::time_point::max()) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, until);
    }
  }
  return std::nullopt;
}

std::optional<Event> EventQueue::pop_event()
{
  if (served_ == events_.size()) {
    return std::nullopt;
  }
  Event event = std::move(events_[served_++]);
  if (served_ == events_.size() || served_ >= 1024) {
    events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(served_));
    served_ = 0;
  }
  return event;
}

std::optional<Event> EventQueue::pop_due_timer(Clock::time_point now)
{
  while (!timers_.empty() && timers_.front().due <= now) {
    std::pop_heap(timers_.begin(), timers_.end(), &later);
    const TimedEvent due = std::move(timers_.back());
    timers_.pop_back();
    if (!due.is_void()) {
      return Event{due.timer, TimerImpl::source_of(due.generation), {}};
    }
  }
  return std::nullopt;
}

void EventQueue::stop()
{
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
}

bool EventQueue::take_stop()
{
  const std::lock_guard lock(mutex_);
  return std::exchange(stop_, false);
}

bool EventQueue::stop_requested() const
{
  const std::lock_guard lock(mutex_);
  return stop_;
}

void EventQueue::end()
{
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
}

bool EventQueue::ended() const
{
  const std::lock_guard lock(mutex_);
  return ended_;
}

std::vector<Event> EventQueue::extract(const PendingEvents & events)
{
  const auto belongs = [&events](const std::shared_ptr<Waitable> & waitable) {
    return waitable && &waitable->node()->pending_events() == &events;
  };
  std::vector<std::shared_ptr<Waitable>>
      kept;  // released after the lock: the last reference may be one of these
  std::vector<Event> taken;
  const std::lock_guard lock(mutex_);
  std::vector<Event> rest;
  while (auto next = pop_event()) {
    Event & event = *next;
    kept.push_back(event.waitable.lock());
    if (belongs(kept.back())) {
      taken.push_back(std::move(event));
    } else {
      rest.push_back(std::move(event));
    }
  }
  events_.swap(rest);
  return taken;
}

const EventQueue *& EventQueue::current() noexcept
{
  thread_local const EventQueue * queue = nullptr;
  return queue;
}

}  // namespace rcl_cxx::detail
