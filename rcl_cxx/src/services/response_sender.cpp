#include "services/response_sender.hpp"

#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
constexpr std::chrono::milliseconds kRetryPeriod{100};
constexpr std::chrono::seconds kRetryLimit{5};
}  // namespace

void ResponseSender::send(Response response)
{
  response.deadline = std::chrono::steady_clock::now() + kRetryLimit;
  try_to_send(std::move(response));
}

void ResponseSender::try_to_send(Response response)
{
  rcl_ret_t code = guard_serialization(response.send);
  if (code == kCannotSerialize && response.send_replacement) {
    RCL_CXX_ERROR(node_->get_logger(), "response replaced: {}", take_rcl_error());
    response.send = std::exchange(response.send_replacement, {});
    code = guard_serialization(response.send);
  }
  if (code != RCL_RET_TIMEOUT || std::chrono::steady_clock::now() >= response.deadline) {
    response.done(code);
    return;
  }
  rcl_reset_error();
  const std::lock_guard lock(mutex_);
  if (stopped_) {
    return;
  }
  responses_.push_back(std::move(response));
  if (!timer_) {
    timer_ = make_waitable<TimerImpl>(node_, kRetryPeriod, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->send_next();
      }
    });
  }
  timer_->call_once_in(kRetryPeriod);
}

void ResponseSender::send_next()
{
  Response response;
  {
    const std::lock_guard lock(mutex_);
    if (responses_.empty()) {
      return;
    }
    response = std::move(responses_.front());
    responses_.pop_front();
    if (!responses_.empty()) {
      timer_->call_once_in(kRetryPeriod);
    }
  }
  try_to_send(std::move(response));
}

void ResponseSender::stop() noexcept
{
  std::deque<Response> dropped;  // destroyed without the lock: they may hold the last references
  std::shared_ptr<TimerImpl> timer;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped.swap(responses_);
    timer.swap(timer_);
  }
  if (timer) {
    timer->close();
  }
}

}  // namespace rcl_cxx::detail
