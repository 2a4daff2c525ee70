#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "rcl_cxx/callback_group.hpp"

namespace rcl_cxx {
namespace detail {
class NodeImpl;
class TimerImpl;
}  // namespace detail

/// A periodic callback by the steady clock, created by Node::create_wall_timer. The callback is due at start
/// + n * period, without drift; periods that have been missed are skipped. It runs in the thread of its
/// group.
/// All members are thread-safe.
class Timer {
 public:
  using SharedPtr = std::shared_ptr<Timer>;

  Timer(std::shared_ptr<detail::NodeImpl> node, std::chrono::nanoseconds period,
        std::function<void()> callback, CallbackGroup::SharedPtr group = {});
  /// Waits for a running callback (see SubscriptionBase).
  ~Timer();
  Timer(const Timer &) = delete;
  Timer & operator=(const Timer &) = delete;

  /// Stops the timer until reset().
  void cancel();
  bool is_canceled() const;
  /// Restarts the timer: the next call is one period from now.
  void reset();

 private:
  std::shared_ptr<detail::TimerImpl> impl_;
};

}  // namespace rcl_cxx
