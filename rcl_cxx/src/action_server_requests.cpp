#include <fmt/format.h>

#include "action_messages.hpp"
#include "action_server_impl.hpp"
#include "node_impl.hpp"
#include "ns_per_second.hpp"
#include "rcl_error.hpp"

/// What clients ask of an action server: goals, cancellations, results. In the executor's thread.
namespace rcl_cxx::detail {
namespace {
bool nothing_to_take(rcl_ret_t code)
{
  if (code == RCL_RET_ACTION_SERVER_TAKE_FAILED) {
    rcl_reset_error();
    return true;
  }
  return false;
}
}  // namespace

void ActionServerImpl::take_goal()
{
  const std::shared_ptr<void> request = ops_.make_goal_request();
  rmw_request_id_t request_id;
  const rcl_ret_t code = rcl_action_take_goal_request(&server_, &request_id, request.get());
  if (nothing_to_take(code)) {
    return;
  }
  check_rcl(code, name_, "cannot take a goal");
  const GoalUUID id = ops_.goal_id_of_goal_request(request.get());
  if (is_known(id)) {
    return reject(id, request_id, "there is a goal of this id already");
  }
  DeferredGoal goal{request_id, request};
  const GoalDecision decision = decide_goal(id, request.get());
  if (const auto * const deferred = std::get_if<DeferredGoalResponse>(&decision)) {
    defer(id, std::move(goal), *deferred);
  } else {
    respond(id, goal, std::get<GoalResponse>(decision));
  }
}

bool ActionServerImpl::is_known(const GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  return goals_.count(id) != 0 || deferred_goals_.count(id) != 0;
}

void ActionServerImpl::reject(const GoalUUID & id, const rmw_request_id_t & request_id,
                              const std::string & reason)
{
  RCL_CXX_WARN(node()->get_logger(), "{}: goal {} refused: {}", name_, id.short_string(), reason);
  answer(&rcl_action_send_goal_response, request_id, ops_.make_goal_response(false, 0, 0));
}

void ActionServerImpl::respond(const GoalUUID & id, const DeferredGoal & goal, const GoalResponse & response)
{
  if (!response) {
    return reject(id, goal.request_id, response.error());
  }
  if (auto accepted = accept(id, goal.request)) {
    announce(goal.request_id, std::move(*accepted));
  } else {
    discard(id);
    reject(id, goal.request_id, accepted.error());
  }
}

void ActionServerImpl::discard(const GoalUUID & id) noexcept
{
  call("discarded", id, [&] {
    if (erased_.discarded) {
      erased_.discarded(id);
    }
  });
}

void ActionServerImpl::announce(const rmw_request_id_t & request,
                                std::shared_ptr<ServerGoalHandleBase> accepted)
{
  const std::int64_t stamp = accepted->accepted_ns();
  auto response = ops_.make_goal_response(true, static_cast<std::int32_t>(stamp / kNsPerSecond),
                                          static_cast<std::uint32_t>(stamp % kNsPerSecond));
  answer(&rcl_action_send_goal_response, request, std::move(response),
         [this, request, accepted](bool delivered) {
           const auto goal = find(accepted->get_goal_id());
           if (!delivered || !goal || !accepted->is_active()) {
             // The client does not know of the goal, and dropping the handle aborts it; or the goal has ended
             // while its client was looked for.
             discard(accepted->get_goal_id());
             return;
           }
           watch_client(*goal, request);
           {
             const std::lock_guard lock(mutex_);
             publish_status_locked();
           }
           run_accepted(accepted);
           check_clients();  // the sooner a client is discovered, the sooner its end is noticed
         });
}

GoalDecision ActionServerImpl::decide_goal(const GoalUUID & id, const void * request) noexcept
{
  try {
    return erased_.goal ? erased_.goal(id, request) : GoalResponse{};
  } catch (const std::exception & error) {
    return GoalResponse{tl::unexpect, error.what()};
  } catch (...) {
    return GoalResponse{tl::unexpect, "the goal handler threw something that is no std::exception"};
  }
}

tl::expected<std::shared_ptr<ServerGoalHandleBase>, std::string> ActionServerImpl::accept(
    const GoalUUID & id, const std::shared_ptr<void> & request)
{
  const std::lock_guard lock(mutex_);
  if (!node()->get_context().ok()) {
    return tl::make_unexpected(std::string("shutting down"));
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
  std::shared_ptr<ServerGoalHandleBase> handle = ops_.make_handle(goal, request);
  goal->handle = handle;
  return handle;
}

void ActionServerImpl::answer(Send send, const rmw_request_id_t & request, std::shared_ptr<void> response,
                              std::function<void(bool)> done, std::shared_ptr<void> instead)
{
  const auto self = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  answers_->send(
      [self, send, request, response, instead]() -> rcl_ret_t {
        rmw_request_id_t to = request;
        try {
          return send(&self->server_, &to, response.get());
        } catch (...) {
          RCL_CXX_ERROR(self->node()->get_logger(),
                        "{}: the middleware cannot send an answer{}: has a text a zero byte?", self->name_,
                        instead ? ", its client gets another one" : "");
          return instead ? send(&self->server_, &to, instead.get()) : RCL_RET_ERROR;
        }
      },
      [self, done = std::move(done)](rcl_ret_t code) {
        if (code != RCL_RET_OK) {
          RCL_CXX_WARN(self->node()->get_logger(), "{}: an answer did not reach its client: {}", self->name_,
                       take_rcl_error());
        }
        if (done) {
          done(code == RCL_RET_OK);
        }
      });
}

void ActionServerImpl::send_result(const rmw_request_id_t & request, ServerGoalImpl & goal)
{
  answer(&rcl_action_send_result_response, request, goal.result_response, {},
         missing_result(goal.get_status()));
  goal.result_sent = true;
}

void ActionServerImpl::run_accepted(std::shared_ptr<ServerGoalHandleBase> handle) noexcept
{
  const std::string id = handle->get_goal_id().short_string();
  try {
    erased_.accepted(handle);
    return;
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {}", name_, id, error.what());
  } catch (...) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: its handler threw something that is no std::exception",
                  name_, id);
  }
  if (handle->is_active()) {
    if (const auto goal = find(handle->get_goal_id())) {
      finish(*goal, GoalStatus::aborted, missing_result(GoalStatus::aborted));
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
  check_rcl(code, name_, "cannot take a request to cancel");
  const auto response = std::make_shared<action_msgs::srv::CancelGoal::Response>();
  process_cancel(request, *response);
  answer(&rcl_action_send_cancel_response, request_id, response);
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
    if (request.goal_info == action_msgs::msg::GoalInfo()) {  // all goals
      for (auto & [id, goal] : deferred_goals_) {
        goal.canceled = true;
      }
    }
    check_rcl(rcl_action_process_cancel_request(&server_, &rcl_request, &rcl_response), name_,
              "cannot cancel");
    for (std::size_t i = 0; i < rcl_response.msg.goals_canceling.size; ++i) {
      candidates.push_back(to_cpp(rcl_response.msg.goals_canceling.data[i]));
    }
    response.return_code = rcl_response.msg.return_code;
    ignore_rcl(rcl_action_cancel_response_fini(&rcl_response));
  }
  bool all_ended = true;
  for (const auto & info : candidates) {
    const auto goal = find(GoalUUID{info.goal_id.uuid});
    if (goal && decide_cancel(*goal)) {
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

bool ActionServerImpl::decide_cancel(ServerGoalImpl & goal)
{
  std::shared_ptr<ServerGoalHandleBase> handle;
  {
    const std::lock_guard lock(mutex_);
    handle = goal.handle.lock();
    if (!handle || is_terminal(goal.get_status())) {
      return false;
    }
    goal.cancel_being_decided = true;
  }
  const bool granted = ask_cancel(*handle);
  {
    const std::lock_guard lock(mutex_);
    goal.cancel_being_decided = false;
    if (goal.get_status() == GoalStatus::canceled) {
      return true;  // its worker was quicker than its handler
    }
    if (!granted || !goal.update(GOAL_EVENT_CANCEL_GOAL)) {
      return false;
    }
  }
  if (erased_.canceling) {
    call("canceling", handle->get_goal_id(), [&] { erased_.canceling(*handle); });
  }
  return true;
}

bool ActionServerImpl::ask_cancel(ServerGoalHandleBase & handle) noexcept
{
  bool granted = false;
  if (erased_.cancel) {
    call("cancel", handle.get_goal_id(), [&] { granted = erased_.cancel(handle); });
  }
  return granted;
}

void ActionServerImpl::call(const char * name, const GoalUUID & id,
                            const std::function<void()> & handler) const noexcept
{
  try {
    handler();
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {} handler: {}", name_, id.short_string(), name,
                  error.what());
  } catch (...) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {} handler threw something that is no std::exception",
                  name_, id.short_string(), name);
  }
}

bool ActionServerImpl::take_result()
{
  const std::shared_ptr<void> request = ops_.make_result_request();
  rmw_request_id_t request_id;
  const rcl_ret_t code = rcl_action_take_result_request(&server_, &request_id, request.get());
  if (nothing_to_take(code)) {
    return false;
  }
  check_rcl(code, name_, "cannot take a request for a result");
  const GoalUUID id = ops_.goal_id_of_result_request(request.get());
  const std::lock_guard lock(mutex_);
  const auto found = goals_.find(id);
  if (found == goals_.end()) {
    answer(&rcl_action_send_result_response, request_id, missing_result(GoalStatus::unknown));
  } else if (found->second->result_response) {
    send_result(request_id, *found->second);
  } else {
    found->second->result_requests.push_back(request_id);
  }
  return true;
}

}  // namespace rcl_cxx::detail
