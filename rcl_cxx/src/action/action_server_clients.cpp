#include "action/action_server_impl.hpp"
#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"

/// Checks whether the clients of active goals still exist. In the executor's thread.
namespace rcl_cxx::detail {
namespace {
/// Without a check for as long, this process was suspended or starved: the leases of its clients, and theirs of
/// it, may have expired.
constexpr std::chrono::seconds kSuspension{1};
constexpr std::chrono::seconds kRecovery{5};
}  // namespace

void ActionServerImpl::note_check()
{
  const auto now = ClientWatch::Clock::now();
  const std::lock_guard lock(mutex_);
  if (last_check_ && now - *last_check_ > kSuspension) {
    resumed_ = now;
  }
  last_check_ = now;
}

bool ActionServerImpl::was_suspended() const
{
  const auto now = ClientWatch::Clock::now();
  const std::lock_guard lock(mutex_);
  return (last_check_ && now - *last_check_ > kSuspension) || (resumed_ && now - *resumed_ < kRecovery);
}

void ActionServerImpl::watch_client(ServerGoalImpl & goal, const rmw_request_id_t & request)
{
  if (!client_timer_) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    goal.client.emplace(client_of(request), requests_carry_endpoints(), ClientWatch::Clock::now());
    last_check_ = last_check_.value_or(ClientWatch::Clock::now());
  }
  if (client_timer_->is_canceled()) {
    client_timer_->reset();
  }
}

void ActionServerImpl::check_clients()
{
  if (!client_timer_) {
    return;
  }
  const Goals goals = get_active_goals();
  note_check();
  if (goals.empty()) {
    client_timer_->cancel();
    const std::lock_guard lock(mutex_);
    last_check_.reset();
    return;
  }
  const auto known = find_clients(*node(), service_name(kSendGoalName));
  if (!known) {
    if (node()->get_context().ok()) {
      RCL_CXX_WARN_ONCE(node()->get_logger(),
                        "{}: the middleware does not list clients, a lost client is not detected", name_);
    }
    return;
  }
  for (const auto & goal : goals) {
    std::shared_ptr<ServerGoalHandle> handle;
    {
      const std::lock_guard lock(mutex_);
      if (!goal->client || !goal->client->is_lost(*known, ClientWatch::Clock::now())) {
        continue;
      }
      goal->client.reset();
      handle = goal->handle.lock();
    }
    if (handle && handle->is_active()) {
      RCL_CXX_WARN(node()->get_logger(), "{}: goal {}: its client has disappeared", name_,
                   goal->id().short_string());
      call("on_client_lost", goal->id(), [&] { callbacks_.on_client_lost(*handle); });
    }
  }
}

}  // namespace rcl_cxx::detail
