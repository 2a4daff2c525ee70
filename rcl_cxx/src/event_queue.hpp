#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace rcl_cxx::detail {
class Waitable;
class PendingEvents;
class TimerImpl;

/// One thing for the executor's thread to do: serve an entity, run a timer, or run a task. Of an entity that
/// is gone meanwhile nothing is left to do.
struct Event {
  std::weak_ptr<Waitable> waitable;
  std::size_t source = 0;
  std::function<void()> task;
};

/// A timer's next call; void if the timer's generation is another one by then. The number lives outside of
/// the timer so that looking at it never holds the last reference to a timer.
struct TimedEvent {
  std::chrono::steady_clock::time_point due;
  std::weak_ptr<TimerImpl> timer;
  std::size_t generation = 0;
  std::shared_ptr<const std::atomic<std::size_t>> current_generation;

  bool is_void() const noexcept { return current_generation->load() != generation; }
};

/// What an executor serves: events in the order of their arrival, and timers when they are due, in turn.
class EventQueue {
 public:
  using Clock = std::chrono::steady_clock;

  void push(Event event);
  void schedule(TimedEvent event);

  /// The next thing to do. Waits for it until `deadline`; nothing then, or if stopped or ended.
  std::optional<Event> next(Clock::time_point deadline);

  /// One call of next() by one spin, the current or the next, sees it: take_stop().
  void stop();
  bool take_stop();
  bool stop_requested() const;
  /// No more spinning: the context is shut down.
  void end();
  bool ended() const;

  /// Removes and returns the events of a node's entities, and forgets its timers.
  std::vector<Event> extract(const PendingEvents & events);

  /// The queue whose callback runs in this thread, if any.
  static const EventQueue *& current() noexcept;

 private:
  std::optional<Event> pop_due_timer(Clock::time_point now);
  std::optional<Event> pop_event();
  void forget_dead_timers();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Event> events_;  // the first served_ of them are done; keeps its capacity
  std::size_t served_ = 0;
  std::vector<TimedEvent> timers_;  // a heap, earliest first
  std::size_t timers_to_clean_ = 64;
  bool timer_had_its_turn_ = false;
  bool stop_ = false;
  bool ended_ = false;
};

}  // namespace rcl_cxx::detail
