#include "timer_impl.hpp"

#include <fmt/format.h>

#include "node_impl.hpp"
#include "pending_events.hpp"
#include "rcl_cxx/error.hpp"
#include "rcl_cxx/timer.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
std::chrono::nanoseconds checked(std::chrono::nanoseconds period)
{
  if (period <= std::chrono::nanoseconds::zero()) {
    throw Error(fmt::format("timer: the period is {} ns, it must be positive", period.count()));
  }
  return period;
}
}  // namespace

std::shared_ptr<TimerImpl> TimerImpl::create(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period,
                                             std::function<void()> callback)
{
  auto timer = std::make_shared<TimerImpl>(std::move(node), period, std::move(callback));
  timer->node()->pending_events().add_timer(timer);
  return timer;
}

TimerImpl::TimerImpl(std::shared_ptr<NodeImpl> node, std::chrono::nanoseconds period,
                     std::function<void()> callback)
    : Waitable(std::move(node),
               fmt::format("timer of {} ms", std::chrono::duration<double, std::milli>(period).count())),
      callback_(std::move(callback)),
      period_(checked(period)),
      due_(Clock::now() + period)
{
}

std::shared_ptr<TimerImpl> TimerImpl::self()
{
  return std::static_pointer_cast<TimerImpl>(shared_from_this());
}

void TimerImpl::schedule_locked()
{
  const std::size_t generation = ++*generation_;
  if (!canceled_) {
    node()->pending_events().schedule(TimedEvent{due_, self(), generation, generation_});
  }
}

void TimerImpl::execute(std::size_t source)
{
  {
    const std::lock_guard lock(mutex_);
    if (canceled_ || source != source_of(generation_->load())) {
      return;
    }
    const Clock::time_point now = Clock::now();
    due_ += period_;
    if (due_ <= now) {
      due_ += ((now - due_) / period_ + 1) * period_;
    }
    canceled_ = once_;
    schedule_locked();
  }
  callback_();
}

void TimerImpl::cancel()
{
  const std::lock_guard lock(mutex_);
  canceled_ = true;
  ++*generation_;
}

bool TimerImpl::is_canceled() const
{
  const std::lock_guard lock(mutex_);
  return canceled_;
}

void TimerImpl::reset()
{
  set_period(period());
}

void TimerImpl::set_period(std::chrono::nanoseconds period)
{
  const std::lock_guard lock(mutex_);
  period_ = checked(period);
  due_ = Clock::now() + period_;
  canceled_ = false;
  once_ = false;
  schedule_locked();
}

std::chrono::nanoseconds TimerImpl::period() const
{
  const std::lock_guard lock(mutex_);
  return period_;
}

void TimerImpl::call_once_in(std::chrono::nanoseconds delay)
{
  const std::lock_guard lock(mutex_);
  due_ = Clock::now() + delay;
  canceled_ = false;
  once_ = true;
  schedule_locked();
}

void TimerImpl::arm()
{
  const std::lock_guard lock(mutex_);
  schedule_locked();
}

void TimerImpl::disarm()
{
  const std::lock_guard lock(mutex_);
  ++*generation_;
}

void TimerImpl::stop() noexcept
{
  cancel();
}
}  // namespace detail

Timer::Timer(std::shared_ptr<detail::TimerImpl> impl) : impl_(std::move(impl)) {}
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
std::chrono::nanoseconds Timer::period() const
{
  return impl_->period();
}
void Timer::set_period(std::chrono::nanoseconds period)
{
  impl_->set_period(period);
}

}  // namespace rcl_cxx
