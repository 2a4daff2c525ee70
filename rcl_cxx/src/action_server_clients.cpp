#include "action_server_core.hpp"
#include "node_core.hpp"
#include "timer_core.hpp"

/// Whether the clients of active goals are still there. In the executor's thread.
namespace rcl_cxx::detail {

void ActionServerCore::watch_client(GoalCore & goal, const rmw_request_id_t & request)
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

void ActionServerCore::check_clients()
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
    if (node()->context().ok()) {
      RCL_CXX_WARN_ONCE(node()->logger(), "{}: the middleware lists no clients, a lost one is not noticed",
                        name_);
    }
    return;
  }
  std::vector<std::shared_ptr<GoalHandleBase>> lost;
  {
    const std::lock_guard lock(mutex_);
    lost = lost_clients_locked(*known);
  }
  for (const auto & handle : lost) {
    RCL_CXX_WARN(node()->logger(), "{}: goal {}: its client has disappeared", name_,
                 handle->goal_id().short_string());
    call("client_lost", handle->goal_id(), [&] { erased_.client_lost(*handle); });
  }
}

std::vector<std::shared_ptr<GoalHandleBase>> ActionServerCore::lost_clients_locked(
    const ServiceClients & known)
{
  std::vector<std::shared_ptr<GoalHandleBase>> lost;
  const auto now = ClientWatch::Clock::now();
  for (const auto & [id, goal] : goals_) {
    if (!goal->client || is_terminal(goal->status()) || !goal->client->is_lost(known, now)) {
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
