#include "response_retry.hpp"

#include "node_impl.hpp"
#include "rcl_error.hpp"
#include "timer_impl.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr std::chrono::milliseconds kPeriod{100};
constexpr std::chrono::seconds kPatience{5};
}  // namespace

ResponseRetry::ResponseRetry(std::shared_ptr<NodeImpl> node) : node_(std::move(node)) {}

ResponseRetry::~ResponseRetry()
{
  stop();
}

void ResponseRetry::send(Attempt attempt, Done done)
{
  const rcl_ret_t code = attempt();
  if (code != RCL_RET_TIMEOUT) {
    done(code);
    return;
  }
  rcl_reset_error();
  keep(Answer{std::move(attempt), std::move(done), std::chrono::steady_clock::now() + kPatience});
}

void ResponseRetry::keep(Answer answer)
{
  const std::lock_guard lock(mutex_);
  if (stopped_) {
    return;
  }
  answers_.push_back(std::move(answer));
  if (!timer_) {
    timer_ = TimerImpl::create(node_, kPeriod, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->run();
      }
    });
  }
  timer_->call_once_in(kPeriod);
}

void ResponseRetry::run()
{
  Answer answer;
  {
    const std::lock_guard lock(mutex_);
    if (answers_.empty()) {
      return;
    }
    answer = std::move(answers_.front());
    answers_.pop_front();
    if (!answers_.empty() && timer_) {
      timer_->call_once_in(kPeriod);
    }
  }
  const rcl_ret_t code = answer.attempt();
  if (code == RCL_RET_TIMEOUT && std::chrono::steady_clock::now() < answer.deadline) {
    rcl_reset_error();
    keep(std::move(answer));
  } else {
    answer.done(code);
  }
}

void ResponseRetry::stop() noexcept
{
  std::deque<Answer> dropped;  // destroyed after the lock is released: they may hold the last references
  std::shared_ptr<TimerImpl> timer;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped.swap(answers_);
    timer.swap(timer_);
  }
  if (timer) {
    timer->close();
  }
}

}  // namespace rcl_cxx::detail
