#include "timer_core.hpp"

#include <fmt/format.h>

#include "event_hub.hpp"
#include "node_core.hpp"
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

std::shared_ptr<TimerCore> TimerCore::create(std::shared_ptr<NodeCore> node, std::chrono::nanoseconds period,
                                             std::function<void()> callback)
{
  auto timer = std::make_shared<TimerCore>(std::move(node), period, std::move(callback));
  timer->node()->hub().add_timer(timer);
  return timer;
}

TimerCore::TimerCore(std::shared_ptr<NodeCore> node, std::chrono::nanoseconds period,
                     std::function<void()> callback)
    : Entity(std::move(node),
             fmt::format("timer of {} ms", std::chrono::duration<double, std::milli>(period).count())),
      callback_(std::move(callback)),
      period_(checked(period)),
      due_(Clock::now() + period)
{
}

std::shared_ptr<TimerCore> TimerCore::self()
{
  return std::static_pointer_cast<TimerCore>(shared_from_this());
}

void TimerCore::schedule_locked()
{
  const std::size_t generation = ++*generation_;
  if (!canceled_) {
    node()->hub().schedule(TimedEvent{due_, self(), generation, generation_});
  }
}

void TimerCore::execute(std::size_t source)
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

void TimerCore::cancel()
{
  const std::lock_guard lock(mutex_);
  canceled_ = true;
  ++*generation_;
}

bool TimerCore::is_canceled() const
{
  const std::lock_guard lock(mutex_);
  return canceled_;
}

void TimerCore::reset()
{
  set_period(period());
}

void TimerCore::set_period(std::chrono::nanoseconds period)
{
  const std::lock_guard lock(mutex_);
  period_ = checked(period);
  due_ = Clock::now() + period_;
  canceled_ = false;
  once_ = false;
  schedule_locked();
}

std::chrono::nanoseconds TimerCore::period() const
{
  const std::lock_guard lock(mutex_);
  return period_;
}

void TimerCore::call_once_in(std::chrono::nanoseconds delay)
{
  const std::lock_guard lock(mutex_);
  due_ = Clock::now() + delay;
  canceled_ = false;
  once_ = true;
  schedule_locked();
}

void TimerCore::arm()
{
  const std::lock_guard lock(mutex_);
  schedule_locked();
}

void TimerCore::disarm()
{
  const std::lock_guard lock(mutex_);
  ++*generation_;
}

void TimerCore::stop() noexcept
{
  cancel();
}
}  // namespace detail

Timer::Timer(std::shared_ptr<detail::TimerCore> core) : core_(std::move(core)) {}
Timer::~Timer()
{
  core_->close();
}
void Timer::cancel()
{
  core_->cancel();
}
bool Timer::is_canceled() const
{
  return core_->is_canceled();
}
void Timer::reset()
{
  core_->reset();
}
std::chrono::nanoseconds Timer::period() const
{
  return core_->period();
}
void Timer::set_period(std::chrono::nanoseconds period)
{
  core_->set_period(period);
}

}  // namespace rcl_cxx
