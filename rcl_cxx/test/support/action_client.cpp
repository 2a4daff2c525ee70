#include "rcl_cxx_test/action_client.hpp"

#include <algorithm>

#include "action_client_impl.hpp"
#include "events/event_queue.hpp"
#include "node/node_impl.hpp"
#include "rcl_cxx/error.hpp"
#include "wait.hpp"

namespace rcl_cxx {
namespace {
// A wait for a response checks for a shutdown this often.
constexpr std::chrono::nanoseconds kActionShutdownCheckPeriod = std::chrono::milliseconds(20);
}  // namespace

ClientGoalHandleBase::ClientGoalHandleBase(std::shared_ptr<detail::ClientGoalImpl> impl)
    : impl_(std::move(impl))
{
}
ClientGoalHandleBase::~ClientGoalHandleBase() = default;
const GoalUUID & ClientGoalHandleBase::get_goal_id() const noexcept
{
  return impl_->id();
}
GoalStatus ClientGoalHandleBase::get_status() const noexcept
{
  return impl_->status.load();
}

std::future<CancelResponse> ClientGoalHandleBase::async_cancel()
{
  const auto client = impl_->client();
  if (!client) {
    throw Error("goal " + impl_->id().short_string() + " cannot be canceled: its action client is gone");
  }
  return client->cancel(impl_->id(), 0);
}

ActionClientBase::ActionClientBase(std::shared_ptr<detail::NodeImpl> node,
                                   const detail::ActionClientOps & ops, const std::string & action)
    : impl_(detail::make_waitable<detail::ActionClientImpl>(std::move(node), ops, action))
{
}

ActionClientBase::~ActionClientBase()
{
  impl_->close();
  impl_->retire();
}

const std::string & ActionClientBase::get_action_name() const noexcept
{
  return impl_->get_action_name();
}

bool ActionClientBase::action_server_is_ready() const
{
  return impl_->action_server_is_ready();
}

bool ActionClientBase::wait_for_action_server(std::chrono::nanoseconds timeout) const
{
  return detail::wait_for(*impl_->node(), [this] { return action_server_is_ready(); }, timeout);
}

std::future<CancelResponse> ActionClientBase::async_cancel_goal(const GoalUUID & id)
{
  return impl_->cancel(id, 0);
}

std::future<CancelResponse> ActionClientBase::async_cancel_all_goals()
{
  return impl_->cancel(GoalUUID{}, 0);
}

std::future<CancelResponse> ActionClientBase::async_cancel_goals_before(std::int64_t stamp_ns)
{
  return impl_->cancel(GoalUUID{}, stamp_ns);
}

GoalUUID ActionClientBase::send(const void * goal, detail::ErasedGoalCallbacks callbacks)
{
  return impl_->send(goal, std::move(callbacks));
}

void ActionClientBase::abandon(const GoalUUID & id) noexcept
{
  impl_->abandon(id);
}

tl::expected<void, std::string> ActionClientBase::check_blocking_call(std::chrono::nanoseconds timeout) const
{
  if (impl_->node()->default_group()->pending_events().in_own_callback()) {
    return tl::make_unexpected(get_action_name() +
                               ": a blocking call from a callback never returns, use async_send_goal");
  }
  if (!wait_for_action_server(timeout)) {
    return tl::make_unexpected(get_action_name() + ": there is no such action server");
  }
  return {};
}

bool ActionClientBase::wait_until_ready(const std::function<bool(std::chrono::nanoseconds)> & ready_within,
                                        std::chrono::steady_clock::time_point deadline) const
{
  while (impl_->node()->get_context().ok()) {
    const std::chrono::nanoseconds left = deadline - std::chrono::steady_clock::now();
    if (ready_within(std::clamp(left, std::chrono::nanoseconds::zero(), kActionShutdownCheckPeriod))) {
      return true;
    }
    if (left <= std::chrono::nanoseconds::zero()) {
      return false;
    }
  }
  return ready_within(std::chrono::nanoseconds::zero());
}

}  // namespace rcl_cxx
