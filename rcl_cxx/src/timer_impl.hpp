#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

#include "waitable.hpp"

namespace rcl_cxx::detail {
/// A timer. Every change of its schedule gets a new generation number; an executor's entry of an older one is
/// void.
class TimerImpl : public Waitable {
 public:
  using Clock = std::chrono::steady_clock;

  static std::shared_ptr<TimerImpl> create(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period,
                                           std::function<void()> callback);
  TimerImpl(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period, std::function<void()> callback);

  void cancel();
  bool is_canceled() const;
  void reset();
  void set_period(std::chrono::nanoseconds period);
  std::chrono::nanoseconds period() const;
  /// For rare use: the next call in `delay` from now, once.
  void call_once_in(std::chrono::nanoseconds delay);

  /// An executor has come, or gone.
  void arm();
  void disarm();

  /// Events of timers carry their generation where others carry a source.
  static std::size_t source_of(std::size_t generation) noexcept { return generation + kSources; }

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  std::shared_ptr<TimerImpl> self();
  void schedule_locked();

  const std::function<void()> callback_;
  mutable std::mutex mutex_;
  std::chrono::nanoseconds period_;
  Clock::time_point due_;
  bool canceled_ = false;
  bool once_ = false;
  const std::shared_ptr<std::atomic<std::size_t>> generation_ = std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace rcl_cxx::detail
