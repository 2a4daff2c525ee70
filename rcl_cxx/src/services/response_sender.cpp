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
  const auto now = Clock::now();
  Pending pending{std::move(response), kFirstPause, now};
  if (must_wait(pending.response)) {
    pending.give_up_after = now + pending.response.return_limit;
    keep(std::move(pending));
  } else {
    try_to_send(std::move(pending));
  }
}

bool ResponseSender::must_wait(const Response & response) const
{
  const bool may_return = response.return_limit > Clock::duration::zero();
  if (!may_return && !must_not_block()) {
    return false;
  }
  const ClientDiscovery client = response.client();
  return client == ClientDiscovery::gone ? may_return
                                         : client == ClientDiscovery::pending && must_not_block();
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
    if (code == RCL_RET_OK && response.resend_limit > Clock::duration::zero()) {
      keep_sent(std::move(response));
    }
    return;
  }
  rcl_reset_error();
  pending.next = Clock::now() + pending.pause;
  pending.pause = std::min<Clock::duration>(2 * pending.pause, kLongestPause);
  keep(std::move(pending));
}

void ResponseSender::keep_sent(Response response)
{
  const auto now = Clock::now();
  response.done = [](rcl_ret_t) { rcl_reset_error(); };
  const auto limit = std::exchange(response.resend_limit, {});
  keep({std::move(response), kFirstPause, now, now + limit, true});
}

bool ResponseSender::check_sent(Pending one, ClientDiscovery client)
{
  one.lost = one.lost || client == ClientDiscovery::gone;
  if (one.lost && client == ClientDiscovery::found) {
    one.sent = false;
    try_to_send(std::move(one));
    return true;
  }
  if (Clock::now() < one.give_up_after) {
    keep(std::move(one));
  }
  return false;
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
    if (one.sent) {
      sent = check_sent(std::move(one), client) || sent;
    } else if (client == ClientDiscovery::gone && Clock::now() >= one.give_up_after) {
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
