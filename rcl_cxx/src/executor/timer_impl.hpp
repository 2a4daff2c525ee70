#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

#include "events/event_queue.hpp"
#include "executor/waitable.hpp"

namespace rcl_cxx::detail {
class TimerImpl : public Waitable {
 public:
  using Clock = TimerSchedule::Clock;

  /// `group`: empty for the default group of the node.
  TimerImpl(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period, std::function<void()> callback,
            CallbackGroup::SharedPtr group = {});

  void cancel();
  bool is_canceled() const;
  void reset();
  /// Calls the callback once, after `delay`, instead of periodically.
  void call_once_in(std::chrono::nanoseconds delay);

 protected:
  void execute(std::size_t source) override;
  void set_on_ready_callbacks() override;
  void clear_on_ready_callbacks() noexcept override { cancel(); }
  const CallbackGroup & group(std::size_t source) const override
  {
    return group_ ? *group_ : Waitable::group(source);
  }

 private:
  void start(std::chrono::nanoseconds delay, bool once);

  const CallbackGroup::SharedPtr group_;
  const std::function<void()> callback_;
  const std::chrono::nanoseconds period_;
  const std::shared_ptr<TimerSchedule> schedule_ = std::make_shared<TimerSchedule>();
  mutable std::mutex mutex_;  // guards what follows
  Clock::time_point due_;
  bool canceled_ = false;
  bool once_ = false;
};

}  // namespace rcl_cxx::detail
