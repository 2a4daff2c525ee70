#pragma once

#include <chrono>
#include <memory>

namespace rcl_cxx {
namespace detail {
class TimerImpl;
}

/// From Node::create_wall_timer. Steady clock; due times are start + n * period, so they do not drift;
/// periods that were missed altogether are skipped. Runs in the executor's thread. Thread-safe.
class Timer {
 public:
  using SharedPtr = std::shared_ptr<Timer>;

  explicit Timer(std::shared_ptr<detail::TimerImpl> impl);
  /// No callback runs once this has returned (see SubscriptionBase).
  ~Timer();
  Timer(const Timer &) = delete;
  Timer & operator=(const Timer &) = delete;

  /// Not called again until reset().
  void cancel();
  bool is_canceled() const;
  /// Starts anew: the next call is one period from now.
  void reset();
  std::chrono::nanoseconds period() const;
  /// Changes the period and starts anew. @throws Error for a period <= 0.
  void set_period(std::chrono::nanoseconds period);

 private:
  std::shared_ptr<detail::TimerImpl> impl_;
};

}  // namespace rcl_cxx
