#include "rcl_cxx/timer.hpp"

#include <fmt/format.h>

#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_cxx/error.hpp"

namespace rcl_cxx {
namespace detail {
TimerImpl::TimerImpl(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period,
                     std::function<void()> callback, CallbackGroup::SharedPtr group)
    : Waitable(std::move(node),
               fmt::format("timer of {} ms", std::chrono::duration<double, std::milli>(period).count())),
      group_(std::move(group)),
      callback_(std::move(callback)),
      period_(period),
      due_(Clock::now() + period)
{
  if (period <= std::chrono::nanoseconds::zero()) {
    throw Error(fmt::format("timer: the period is {} ns, it must be positive", period.count()));
  }
}

void TimerImpl::set_on_ready_callbacks()
{
  schedule_->timer = weak_from_this();
  schedule_->due = due_;
  group(0).pending_events().add_timer(schedule_);
}

void TimerImpl::execute(std::size_t /*source*/)
{
  {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (canceled_ || now < due_) {
      return;  // canceled or reset after it was due
    }
    due_ += ((now - due_) / period_ + 1) * period_;
    canceled_ = once_;
    schedule_->due = canceled_ ? TimerSchedule::kNever : due_;
  }
  callback_();
}

void TimerImpl::start(std::chrono::nanoseconds delay, bool once)
{
  {
    const std::lock_guard lock(mutex_);
    due_ = Clock::now() + delay;
    canceled_ = false;
    once_ = once;
    schedule_->due = due_;
  }
  group(0).pending_events().wake();
}

void TimerImpl::reset()
{
  start(period_, false);
}

void TimerImpl::call_once_in(std::chrono::nanoseconds delay)
{
  start(delay, true);
}

void TimerImpl::cancel()
{
  const std::lock_guard lock(mutex_);
  canceled_ = true;
  schedule_->due = TimerSchedule::kNever;
}

bool TimerImpl::is_canceled() const
{
  const std::lock_guard lock(mutex_);
  return canceled_;
}
}  // namespace detail

Timer::Timer(std::shared_ptr<detail::NodeImpl> node, std::chrono::nanoseconds period,
             std::function<void()> callback, CallbackGroup::SharedPtr group)
    : impl_(detail::make_waitable<detail::TimerImpl>(std::move(node), period, std::move(callback),
                                                     std::move(group)))
{
}
Timer::~Timer()
{
  impl_->close();
}
void Timer::cancel()
{
  impl_->cancel();
}
bool Timer::is_canceled() const
{
  return impl_->is_canceled();
}
void Timer::reset()
{
  impl_->reset();
}

}  // namespace rcl_cxx
