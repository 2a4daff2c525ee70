#include "action/action_server_impl.hpp"
#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"

/// Checks whether the clients of goals still exist. In the executor's thread.
namespace rcl_cxx::detail {
/// As ROS remaps it: each of an action's services may have a name of its own.
std::string ActionServerImpl::service_name(const char * service) const
{
  return node()->resolve(name_ + "/_action/" + service, true);
}

void ActionServerImpl::watch_client(const std::shared_ptr<ServerGoalImpl> & goal,
                                    const rmw_request_id_t & request)
{
  if (!client_timer_) {
    return;
  }
  const std::lock_guard lock(mutex_);
  watched_goals_.push_back(goal);
  goal->client.emplace(client_of(request), requests_carry_endpoints(), ClientWatch::Clock::now());
  if (client_timer_->is_canceled()) {
    client_timer_->reset();
  }
}

ActionServerImpl::Goals ActionServerImpl::get_watched_goals()
{
  const std::lock_guard lock(mutex_);
  std::erase_if(watched_goals_, [](const auto & goal) { return !goal->client || !goal->needs_client(); });
  if (watched_goals_.empty()) {
    client_timer_->cancel();
  }
  return watched_goals_;
}

void ActionServerImpl::check_clients()
{
  if (!client_timer_) {
    return;
  }
  const Goals goals = get_watched_goals();
  if (goals.empty()) {
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
      handle = goal->needs_client() ? goal->handle.lock() : nullptr;
    }
    if (handle) {
      call("on_client_lost", goal->id(), [&] { callbacks_.on_client_lost(*handle); });
      RCL_CXX_WARN(node()->get_logger(), "{}: goal {}: its client has disappeared", name_,
                   goal->id().short_string());
    }
  }
}

}  // namespace rcl_cxx::detail
