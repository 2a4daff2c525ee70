#include "rcl_cxx/action_client.hpp"

#include <algorithm>

#include "action_client_core.hpp"
#include "node_core.hpp"
#include "rcl_cxx/error.hpp"

namespace rcl_cxx {
namespace {
// A wait for an answer looks this often whether the context still runs.
constexpr std::chrono::nanoseconds kShutdownCheckPeriod = std::chrono::milliseconds(20);
}  // namespace

const char * to_string(CancelCode code) noexcept
{
  switch (code) {
    case CancelCode::none:
      return "canceling";
    case CancelCode::rejected:
      return "rejected";
    case CancelCode::unknown_goal:
      return "unknown goal";
    case CancelCode::goal_terminated:
      return "the goal has ended";
  }
  return "invalid";
}

ClientGoalHandleBase::ClientGoalHandleBase(std::shared_ptr<detail::ClientGoalCore> core)
    : core_(std::move(core))
{
}
ClientGoalHandleBase::~ClientGoalHandleBase() = default;
const GoalId & ClientGoalHandleBase::goal_id() const noexcept
{
  return core_->id();
}
GoalStatus ClientGoalHandleBase::status() const noexcept
{
  return core_->status.load();
}

std::future<CancelResponse> ClientGoalHandleBase::cancel()
{
  const auto client = core_->client();
  if (!client) {
    throw Error("goal " + core_->id().short_string() + " cannot be canceled: its action client is gone");
  }
  return client->cancel(core_->id(), 0);
}

ActionClientBase::ActionClientBase(std::shared_ptr<detail::ActionClientCore> core) : core_(std::move(core)) {}

ActionClientBase::~ActionClientBase()
{
  core_->close();
  core_->retire();
}

const std::string & ActionClientBase::action_name() const noexcept
{
  return core_->action_name();
}

bool ActionClientBase::server_is_ready() const
{
  return core_->server_is_ready();
}

bool ActionClientBase::wait_for_server(std::chrono::nanoseconds timeout) const
{
  return core_->node()->wait_for([this] { return server_is_ready(); }, timeout);
}

std::future<CancelResponse> ActionClientBase::cancel_goal(const GoalId & id)
{
  return core_->cancel(id, 0);
}

std::future<CancelResponse> ActionClientBase::cancel_all_goals()
{
  return core_->cancel(GoalId{}, 0);
}

std::future<CancelResponse> ActionClientBase::cancel_goals_before(std::int64_t stamp_ns)
{
  return core_->cancel(GoalId{}, stamp_ns);
}

GoalId ActionClientBase::send(const void * goal, detail::ErasedGoalCallbacks callbacks)
{
  return core_->send(goal, std::move(callbacks));
}

void ActionClientBase::abandon(const GoalId & id) noexcept
{
  core_->abandon(id);
}

tl::expected<void, std::string> ActionClientBase::check_blocking_call(std::chrono::nanoseconds timeout) const
{
  if (core_->node()->in_own_callback()) {
    return tl::make_unexpected(action_name() +
                               ": a blocking call from a callback would wait for ever, use send_goal");
  }
  if (!wait_for_server(timeout)) {
    return tl::make_unexpected(action_name() + ": there is no such action server");
  }
  return {};
}

bool ActionClientBase::wait_until_ready(const std::function<bool(std::chrono::nanoseconds)> & ready_within,
                                        std::chrono::steady_clock::time_point deadline) const
{
  while (core_->node()->context().ok()) {
    const std::chrono::nanoseconds left = deadline - std::chrono::steady_clock::now();
    if (ready_within(std::clamp(left, std::chrono::nanoseconds::zero(), kShutdownCheckPeriod))) {
      return true;
    }
    if (left <= std::chrono::nanoseconds::zero()) {
      return false;
    }
  }
  return ready_within(std::chrono::nanoseconds::zero());
}

}  // namespace rcl_cxx
