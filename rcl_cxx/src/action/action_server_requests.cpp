#include <fmt/format.h>

#include "action/action_messages.hpp"
#include "action/action_server_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/to_time.hpp"

/// The requests of clients: goals, cancel requests, results. In the executor's thread.
namespace rcl_cxx::detail {
namespace {
constexpr ActionServerImpl::ServiceOfAction kGoalService{&rcl_action_send_goal_response, kSendGoalName};
constexpr ActionServerImpl::ServiceOfAction kCancelService{&rcl_action_send_cancel_response, "cancel_goal"};
constexpr ActionServerImpl::ServiceOfAction kResultService{&rcl_action_send_result_response, "get_result"};

bool nothing_to_take(rcl_ret_t code)
{
  if (code == RCL_RET_ACTION_SERVER_TAKE_FAILED) {
    rcl_reset_error();
    return true;
  }
  return false;
}
}  // namespace

void ActionServerImpl::call(const char * name, const GoalUUID & id,
                            const std::function<void()> & callback) const noexcept
{
  try {
    callback();
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {} failed: {}", name_, id.short_string(), name,
                  error.what());
  } catch (...) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {} threw an unknown exception", name_,
                  id.short_string(), name);
  }
}

void ActionServerImpl::respond(const ServiceOfAction & service, const rmw_request_id_t & request,
                               std::shared_ptr<void> response,
                               std::function<std::shared_ptr<void>()> replacement,
                               std::function<void(bool)> done)
{
  const auto self = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  const auto send_to = [self, send = service.send, request](void * message) {
    rmw_request_id_t id = request;
    return send(&self->server_, &id, message);
  };
  ResponseSender::Send send_replacement;
  if (replacement) {
    send_replacement = [send_to, replacement = std::move(replacement)] {
      return send_to(replacement().get());
    };
  }
  sender_->send({[send_to, response = std::move(response)] { return send_to(response.get()); },
                 std::move(send_replacement),
                 [self, request, name = service.name] {
                   return discovery_of(request, *self->node(), self->service_name(name));
                 },
                 [self, done = std::move(done)](rcl_ret_t code) {
                   if (code != RCL_RET_OK) {
                     RCL_CXX_WARN(self->node()->get_logger(), "{}: a response was not delivered: {}",
                                  self->name_, take_rcl_error());
                   }
                   if (done) {
                     done(code == RCL_RET_OK);
                   }
                 }});
}

void ActionServerImpl::take_goal()
{
  const std::shared_ptr<void> request = make_message(type_.goal_request);
  rmw_request_id_t request_id;
  const rcl_ret_t code = rcl_action_take_goal_request(&server_, &request_id, request.get());
  if (nothing_to_take(code)) {
    return;
  }
  check_rcl(code, name_, "cannot take a goal");
  const GoalUUID id = type_.get_goal_id(request.get());
  const std::uint64_t cancels_before = cancels_of_all();
  // rcl_action checks this only after handle_goal.
  if (is_known(id)) {
    return reject(id, request_id, "a goal with this id exists already");
  }
  const GoalDecision decision = handle_goal(id, request.get());
  if (const auto * const deferred = std::get_if<DeferredGoalResponse>(&decision)) {
    defer(id, {request_id, request, cancels_before}, *deferred);
  } else {
    send_decision(id, {request_id, request, cancels_before}, std::get<GoalResponse>(decision));
  }
}

std::uint64_t ActionServerImpl::cancels_of_all() const
{
  const std::lock_guard lock(mutex_);
  return cancels_of_all_;
}

bool ActionServerImpl::is_known(const GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  return goals_.count(id) != 0 || deferred_goals_.count(id) != 0;
}

void ActionServerImpl::reject(const GoalUUID & id, const rmw_request_id_t & request_id,
                              const std::string & reason)
{
  RCL_CXX_WARN(node()->get_logger(), "{}: goal {} rejected: {}", name_, id.short_string(), reason);
  respond(kGoalService, request_id, make_message(type_.goal_response));
}

void ActionServerImpl::send_decision(const GoalUUID & id, const GoalRequest & request,
                                     const GoalResponse & response)
{
  if (!response) {
    return reject(id, request.id, response.error());
  }
  if (auto handle = accept(id, request)) {
    send_acceptance(request.id, std::move(*handle));
  } else {
    discard(id);
    reject(id, request.id, handle.error());
  }
}

void ActionServerImpl::discard(const GoalUUID & id) noexcept
{
  if (callbacks_.on_goal_discarded) {
    call("on_goal_discarded", id, [&] { callbacks_.on_goal_discarded(id); });
  }
}

void ActionServerImpl::send_acceptance(const rmw_request_id_t & request,
                                       std::shared_ptr<ServerGoalHandle> handle)
{
  auto response = make_message(type_.goal_response);
  type_.set_goal_response(response.get(), true, handle->get_goal_stamp());
  respond(kGoalService, request, std::move(response), {}, [this, request, handle](bool delivered) {
    const auto goal = find(handle->get_goal_id());
    if (!delivered || !goal || !handle->is_active()) {
      // The client does not know of the goal; releasing the handle aborts it. Or the goal was aborted
      // while the response was being delivered.
      discard(handle->get_goal_id());
      return;
    }
    watch_client(goal, request);
    run_accepted(handle);  // first: publishing the status must not delay the goal
    {
      const std::lock_guard lock(mutex_);
      publish_status_locked();
    }
    check_clients();  // a client has to be discovered before its end can be noticed
  });
}

GoalDecision ActionServerImpl::handle_goal(const GoalUUID & id, const void * request) noexcept
{
  try {
    return callbacks_.handle_goal ? callbacks_.handle_goal(id, type_.get_goal(request)) : GoalResponse{};
  } catch (const std::exception & error) {
    return GoalResponse{tl::unexpect, error.what()};
  } catch (...) {
    return GoalResponse{tl::unexpect, "handle_goal threw an unknown exception"};
  }
}

tl::expected<std::shared_ptr<ServerGoalHandle>, std::string> ActionServerImpl::accept(
    const GoalUUID & id, const GoalRequest & request)
{
  const std::lock_guard lock(mutex_);
  if (!node()->get_context().ok()) {
    return tl::make_unexpected(std::string("shutting down"));
  }
  if (cancels_of_all_ != request.cancels_before) {
    return tl::make_unexpected(std::string("canceled before it was accepted"));
  }
  rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
  std::copy(id.bytes.begin(), id.bytes.end(), std::begin(info.goal_id.uuid));
  const rcl_action_goal_handle_t * const rcl_handle = rcl_action_accept_new_goal(&server_, &info);
  if (rcl_handle == nullptr) {
    return tl::make_unexpected(take_rcl_error());
  }
  const auto self = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  const auto goal = std::make_shared<ServerGoalImpl>(self, id, *rcl_handle);
  goals_.emplace(id, goal);
  goal->update(GOAL_EVENT_EXECUTE);
  auto handle = std::make_shared<ServerGoalHandle>(goal, type_, request.message);
  goal->handle = handle;
  return handle;
}

void ActionServerImpl::run_accepted(const std::shared_ptr<ServerGoalHandle> & handle) noexcept
{
  bool returned = false;
  call("handle_accepted", handle->get_goal_id(), [&] {
    callbacks_.handle_accepted(handle);
    returned = true;
  });
  if (!returned) {
    if (const auto goal = find(handle->get_goal_id())) {
      abort(*goal);
    }
  }
}

void ActionServerImpl::take_cancel()
{
  action_msgs::srv::CancelGoal::Request request;
  rmw_request_id_t request_id;
  const rcl_ret_t code = rcl_action_take_cancel_request(&server_, &request_id, &request);
  if (nothing_to_take(code)) {
    return;
  }
  check_rcl(code, name_, "cannot take a cancel request");
  const auto response = std::make_shared<action_msgs::srv::CancelGoal::Response>();
  process_cancel(request, *response);
  respond(kCancelService, request_id, response);
}

void ActionServerImpl::process_cancel(const action_msgs::srv::CancelGoal::Request & request,
                                      action_msgs::srv::CancelGoal::Response & response)
{
  using Response = action_msgs::srv::CancelGoal::Response;
  rcl_action_cancel_request_t rcl_request = rcl_action_get_zero_initialized_cancel_request();
  rcl_request.goal_info = to_c(request.goal_info);
  rcl_action_cancel_response_t rcl_response = rcl_action_get_zero_initialized_cancel_response();
  std::vector<action_msgs::msg::GoalInfo> candidates;
  {
    const std::lock_guard lock(mutex_);
    if (request.goal_info == action_msgs::msg::GoalInfo()) {
      ++cancels_of_all_;  // also of those that are being checked
    }
    check_rcl(rcl_action_process_cancel_request(&server_, &rcl_request, &rcl_response), name_,
              "cannot process a cancel request");
    for (std::size_t i = 0; i < rcl_response.msg.goals_canceling.size; ++i) {
      candidates.push_back(to_cpp(rcl_response.msg.goals_canceling.data[i]));
    }
    response.return_code = rcl_response.msg.return_code;
    ignore_rcl(rcl_action_cancel_response_fini(&rcl_response));
  }
  bool all_ended = true;
  for (const auto & info : candidates) {
    const auto goal = find(GoalUUID{info.goal_id.uuid});
    if (goal && try_to_cancel(*goal)) {
      response.goals_canceling.push_back(info);
    } else if (goal && !is_terminal(goal->get_status())) {
      all_ended = false;
    }
  }
  if (!candidates.empty() && response.goals_canceling.empty()) {
    response.return_code = all_ended ? Response::ERROR_GOAL_TERMINATED : Response::ERROR_REJECTED;
  }
  if (!response.goals_canceling.empty()) {
    const std::lock_guard lock(mutex_);
    publish_status_locked();
  }
}

bool ActionServerImpl::try_to_cancel(ServerGoalImpl & goal)
{
  std::shared_ptr<ServerGoalHandle> handle;
  {
    const std::lock_guard lock(mutex_);
    handle = goal.handle.lock();
    if (!handle || is_terminal(goal.get_status())) {
      return false;
    }
    goal.in_handle_cancel = true;
  }
  bool accepted = false;
  if (callbacks_.handle_cancel) {
    call("handle_cancel", goal.id(), [&] { accepted = callbacks_.handle_cancel(*handle); });
  }
  {
    const std::lock_guard lock(mutex_);
    goal.in_handle_cancel = false;
    if (goal.get_status() == GoalStatus::canceled) {
      return true;  // the goal's thread has finished it in the meantime
    }
    if (!accepted || !goal.update(GOAL_EVENT_CANCEL_GOAL)) {
      return false;
    }
  }
  if (callbacks_.on_canceling) {
    call("on_canceling", goal.id(), [&] { callbacks_.on_canceling(*handle); });
  }
  return true;
}

bool ActionServerImpl::take_result()
{
  const std::shared_ptr<void> request = make_message(type_.result_request);
  rmw_request_id_t request_id;
  const rcl_ret_t code = rcl_action_take_result_request(&server_, &request_id, request.get());
  if (nothing_to_take(code)) {
    return false;
  }
  check_rcl(code, name_, "cannot take a result request");
  const GoalUUID id = type_.get_goal_id_of_result_request(request.get());
  const auto goal = find(id);
  if (!goal) {
    respond(kResultService, request_id, make_empty_result(id, GoalStatus::unknown));
    return true;
  }
  {
    const std::lock_guard lock(mutex_);
    if (!goal->result_response) {
      goal->result_requests.push_back(request_id);
      return true;
    }
  }
  send_result(request_id, *goal);
  return true;
}

void ActionServerImpl::send_result(const rmw_request_id_t & request, ServerGoalImpl & goal)
{
  const GoalUUID id = goal.id();
  const GoalStatus status = goal.get_status();
  respond(kResultService, request, goal.result_response,
          [this, id, status] { return make_empty_result(id, status); });
  goal.result_sent = true;
}

}  // namespace rcl_cxx::detail
