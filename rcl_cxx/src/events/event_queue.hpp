#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace rcl_cxx::detail {
class Waitable;

/// One item of work for the executor's thread: either `source` of `waitable`, or `task`.
struct Event {
  std::weak_ptr<Waitable> waitable;
  std::size_t source = 0;
  std::function<void()> task;
};

/// The next due time of a timer. It lives outside of the timer, so that the queue never holds the last
/// reference to a timer.
struct TimerSchedule {
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point kNever = Clock::time_point::max();

  std::weak_ptr<Waitable> timer;
  std::atomic<Clock::time_point> due{kNever};
};

/// The work of one executor, in order of arrival. A timer is appended when it is due.
class EventQueue {
 public:
  using Clock = std::chrono::steady_clock;

  void push(Event event);
  void add_timer(std::shared_ptr<TimerSchedule> timer);
  /// To call after a timer has become due earlier.
  void wake();

  /// Waits for the next event until `deadline`. Returns nothing on timeout, cancel() and end().
  std::optional<Event> next(Clock::time_point deadline);

  /// Cancels the current spin, or the next one if no thread spins. Reset by take_cancel().
  void cancel();
  bool take_cancel();
  /// The context is shut down: no thread spins anymore.
  void end();
  bool is_canceled_or_ended() const;

  /// The queue whose event is being executed in this thread, if any.
  static const EventQueue *& current() noexcept;

 private:
  /// Appends the timers that are due and returns when the next one is.
  Clock::time_point push_due_timers();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Event> events_;
  std::vector<std::shared_ptr<TimerSchedule>> timers_;
  bool canceled_ = false;
  bool ended_ = false;
};

/// Passes the events of a callback group to the queue of its executor. Events that arrive before the group
/// has an executor are kept.
class PendingEvents {
 public:
  void push(Event event);
  void add_timer(std::shared_ptr<TimerSchedule> timer);
  void wake();

  /// Returns false if the group has an executor already.
  bool attach(std::shared_ptr<EventQueue> queue);
  /// True in a callback of the executor: waiting for another callback of this group would never end.
  bool in_own_callback() const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<EventQueue> queue_;
  std::vector<Event> events_;
  std::vector<std::shared_ptr<TimerSchedule>> timers_;
};

}  // namespace rcl_cxx::detail
