#include <algorithm>

#include "action/action_server_impl.hpp"
#include "node/node_impl.hpp"

/// Goal requests whose response is sent later.
namespace rcl_cxx::detail {
namespace {
/// Rejects the goal when it is destroyed; a response that was sent before has precedence.
class DeferredResponder {
 public:
  explicit DeferredResponder(SendGoalResponse send) : send_(std::move(send)) {}
  ~DeferredResponder() { send_(GoalResponse{tl::unexpect, "its check ended without a response"}); }
  DeferredResponder(const DeferredResponder &) = delete;
  DeferredResponder & operator=(const DeferredResponder &) = delete;
  void send(GoalResponse response) const { send_(std::move(response)); }

 private:
  const SendGoalResponse send_;
};
}  // namespace

void ActionServerImpl::defer(const GoalUUID & id, GoalRequest request, const DeferredGoalResponse & response)
{
  {
    const std::lock_guard lock(mutex_);
    deferred_goals_.emplace(id, DeferredGoal{std::move(request)});
  }
  const std::weak_ptr<ActionServerImpl> weak = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  const auto responder = std::make_shared<const DeferredResponder>([weak, id](GoalResponse decision) {
    if (const auto self = weak.lock()) {
      self->set_response(id, std::move(decision));
    }
  });
  call("handle_goal", id,
       [&] { response.start([responder](GoalResponse decision) { responder->send(std::move(decision)); }); });
}

void ActionServerImpl::set_response(const GoalUUID & id, GoalResponse response) noexcept
{
  {
    const std::lock_guard lock(mutex_);
    const auto goal = deferred_goals_.find(id);
    if (goal == deferred_goals_.end() || goal->second.response) {
      return;
    }
    goal->second.response = std::move(response);
  }
  notify(kDeferredResponse);
}

void ActionServerImpl::send_deferred_response()
{
  std::map<GoalUUID, DeferredGoal>::node_type node;
  {
    const std::lock_guard lock(mutex_);
    const auto ready = std::find_if(deferred_goals_.begin(), deferred_goals_.end(),
                                    [](const auto & entry) { return entry.second.response.has_value(); });
    if (ready == deferred_goals_.end()) {
      return;
    }
    node = deferred_goals_.extract(ready);
  }
  const DeferredGoal & goal = node.mapped();
  send_decision(node.key(), goal.request, *goal.response);
}

void ActionServerImpl::reject_deferred_goals(const char * reason) noexcept
{
  std::map<GoalUUID, DeferredGoal> goals;
  {
    const std::lock_guard lock(mutex_);
    goals.swap(deferred_goals_);
  }
  for (const auto & [id, goal] : goals) {
    call("handle_goal", id, [&, &id = id, &goal = goal] { reject(id, goal.request.id, reason); });
    discard(id);
  }
}

}  // namespace rcl_cxx::detail
