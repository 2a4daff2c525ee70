#include "services/response_sender.hpp"

#include <algorithm>

#include "events/event_queue.hpp"
#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"

namespace rcl_cxx::detail {
namespace {
/// A graph query takes 28 us with 93 actions and one client each.
constexpr std::chrono::milliseconds kCheckPeriod{20};
/// The middleware may not be able to send although the reader has been discovered, for example because of its
/// quality of service. Each attempt blocks the executor, so the pauses between them grow.
constexpr std::chrono::milliseconds kFirstPause{20};
constexpr std::chrono::seconds kLongestPause{1};
}  // namespace

void ResponseSender::send(Response response)
{
  Pending pending{std::move(response), kFirstPause, Clock::now()};
  if (must_not_block() && pending.response.client() == ClientDiscovery::pending) {
    keep(std::move(pending));
  } else {
    try_to_send(std::move(pending));
  }
}

bool ResponseSender::must_not_block() const
{
  return group_ != node_->default_group() && group_->pending_events().in_own_callback();
}

void ResponseSender::try_to_send(Pending pending)
{
  Response & response = pending.response;
  rcl_ret_t code = guard_serialization(response.send);
  if (code == kCannotSerialize && response.send_replacement) {
    RCL_CXX_ERROR(node_->get_logger(), "response replaced: {}", take_rcl_error());
    response.send = std::exchange(response.send_replacement, {});
    code = guard_serialization(response.send);
  }
  if (code != RCL_RET_TIMEOUT) {
    response.done(code);
    return;
  }
  rcl_reset_error();
  pending.next = Clock::now() + pending.pause;
  pending.pause = std::min<Clock::duration>(2 * pending.pause, kLongestPause);
  keep(std::move(pending));
}

void ResponseSender::keep(Pending pending)
{
  const std::lock_guard lock(mutex_);
  if (stopped_) {
    return;
  }
  pending_.push_back(std::move(pending));
  if (!timer_) {
    timer_ = make_waitable<TimerImpl>(
        node_, kCheckPeriod,
        [weak = weak_from_this()] {
          if (const auto self = weak.lock()) {
            self->check_clients();
          }
        },
        group_);
  }
  timer_->call_once_in(kCheckPeriod);
}

void ResponseSender::check_clients()
{
  std::list<Pending> pending;
  {
    const std::lock_guard lock(mutex_);
    pending.swap(pending_);
  }
  bool sent = false;  // at most one response, so that the executor can execute other callbacks in between
  for (Pending & one : pending) {
    if (is_stopped()) {
      return;
    }
    const ClientDiscovery client = one.response.client();
    if (client == ClientDiscovery::gone) {
      RCL_SET_ERROR_MSG("its client is gone");
      one.response.done(RCL_RET_TIMEOUT);
    } else if (client == ClientDiscovery::found && !sent && Clock::now() >= one.next) {
      sent = true;
      try_to_send(std::move(one));
    } else {
      keep(std::move(one));
    }
  }
}

bool ResponseSender::is_stopped()
{
  const std::lock_guard lock(mutex_);
  return stopped_;
}

void ResponseSender::stop() noexcept
{
  std::list<Pending> dropped;  // destroyed without the lock: they may hold the last references
  std::shared_ptr<TimerImpl> timer;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    dropped.swap(pending_);
    timer.swap(timer_);
  }
  if (timer) {
    timer->close();
  }
}

}  // namespace rcl_cxx::detail
