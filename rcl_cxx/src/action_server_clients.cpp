#include "action_server_impl.hpp"
#include "node_impl.hpp"
#include "timer_impl.hpp"

/// Whether the clients of active goals are still there. In the executor's thread.
namespace rcl_cxx::detail {

void ActionServerImpl::watch_client(ServerGoalImpl & goal, const rmw_request_id_t & request)
{
  if (!client_check_) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    goal.client.emplace(client_of(request), requests_carry_endpoints(), ClientWatch::Clock::now());
  }
  if (client_check_->is_canceled()) {
    client_check_->reset();
  }
}

void ActionServerImpl::check_clients()
{
  if (!client_check_) {
    return;
  }
  if (active_goal_count() == 0) {
    client_check_->cancel();
    return;
  }
  const auto known = find_clients(*node(), name_ + "/_action/send_goal");
  if (!known) {
    if (node()->get_context().ok()) {
      RCL_CXX_WARN_ONCE(node()->get_logger(),
                        "{}: the middleware lists no clients, a lost one is not noticed", name_);
    }
    return;
  }
  std::vector<std::shared_ptr<ServerGoalHandleBase>> lost;
  {
    const std::lock_guard lock(mutex_);
    lost = lost_clients_locked(*known);
  }
  for (const auto & handle : lost) {
    RCL_CXX_WARN(node()->get_logger(), "{}: goal {}: its client has disappeared", name_,
                 handle->get_goal_id().short_string());
    call("client_lost", handle->get_goal_id(), [&] { erased_.client_lost(*handle); });
  }
}

std::vector<std::shared_ptr<ServerGoalHandleBase>> ActionServerImpl::lost_clients_locked(
    const ServiceClients & known)
{
  std::vector<std::shared_ptr<ServerGoalHandleBase>> lost;
  const auto now = ClientWatch::Clock::now();
  for (const auto & [id, goal] : goals_) {
    if (!goal->client || is_terminal(goal->get_status()) || !goal->client->is_lost(known, now)) {
      continue;
    }
    goal->client.reset();
    if (auto handle = goal->handle.lock()) {
      lost.push_back(std::move(handle));
    }
  }
  return lost;
}

}  // namespace rcl_cxx::detail
