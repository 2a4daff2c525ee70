#include "action_client_impl.hpp"

#include <fmt/format.h>

#include <action_msgs/msg/goal_status_array.hpp>
#include <utility>
#include <vector>

#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/to_time.hpp"
#include "rcl_support/type_support.hpp"

namespace rcl_cxx::detail {
namespace {
enum Source : std::size_t { kGoal, kCancel, kResult, kFeedback, kStatus };

/// Returns false if there is nothing to take.
bool taken(rcl_ret_t code, const std::string & name, const char * what)
{
  if (code == RCL_RET_ACTION_CLIENT_TAKE_FAILED) {
    rcl_reset_error();
    return false;
  }
  check_rcl(code, name, fmt::format("cannot take {}", what));
  return true;
}
}  // namespace

ActionClientImpl::ActionClientImpl(std::shared_ptr<NodeImpl> node, const ActionClientOps & ops,
                                   const std::string & name)
    : Waitable(std::move(node), fmt::format("action client of {}", name)),
      ops_(ops),
      type_support_(*ops.type.type_support())
{
  const rcl_action_client_options_t options = rcl_action_client_get_default_options();
  name_ = this->node()->resolve(name, false);
  const std::lock_guard lock(this->node()->mutex());
  check_rcl(
      rcl_action_client_init(&client_, this->node()->handle(), type_support_.get(), name.c_str(), &options),
      label(), "cannot be created");
  reset_type_support_error();
}

ActionClientImpl::~ActionClientImpl()
{
  const std::lock_guard lock(node()->mutex());
  ignore_rcl(rcl_action_client_fini(&client_, node()->handle()));
}

void ActionClientImpl::set_on_ready_callbacks()
{
  set_callback(rcl_action_client_set_goal_client_callback, client_, kGoal);
  set_callback(rcl_action_client_set_cancel_client_callback, client_, kCancel);
  set_callback(rcl_action_client_set_result_client_callback, client_, kResult);
  set_callback(rcl_action_client_set_feedback_subscription_callback, client_, kFeedback);
  set_callback(rcl_action_client_set_status_subscription_callback, client_, kStatus);
}

void ActionClientImpl::clear_on_ready_callbacks() noexcept
{
  clear_callback(rcl_action_client_set_goal_client_callback, client_);
  clear_callback(rcl_action_client_set_cancel_client_callback, client_);
  clear_callback(rcl_action_client_set_result_client_callback, client_);
  clear_callback(rcl_action_client_set_feedback_subscription_callback, client_);
  clear_callback(rcl_action_client_set_status_subscription_callback, client_);
}

void ActionClientImpl::retire()
{
  // Destroyed after the lock is released: their futures break and wake the threads that wait.
  std::map<std::int64_t, Goal> unanswered;
  std::map<std::int64_t, Goal> without_result;
  std::map<GoalUUID, Goal> goals;
  std::map<std::int64_t, std::promise<CancelResponse>> cancellations;
  std::vector<ErasedGoalCallbacks> callbacks;
  const std::lock_guard lock(mutex_);
  retired_ = true;
  for (const auto & [id, goal] : goals_) {
    callbacks.push_back(std::exchange(goal->callbacks, {}));  // the user's handle may hold the goal
  }
  unanswered.swap(unanswered_);
  without_result.swap(without_result_);
  goals.swap(goals_);
  cancellations.swap(cancellations_);
}

bool ActionClientImpl::action_server_is_ready() const
{
  bool ready = false;
  if (rcl_action_server_is_available(node()->handle(), &client_, &ready) != RCL_RET_OK) {
    rcl_reset_error();  // after the shutdown
    return false;
  }
  return ready;
}

GoalUUID ActionClientImpl::send(const void * goal, ErasedGoalCallbacks callbacks)
{
  const GoalUUID id = GoalUUID::random();
  const std::shared_ptr<void> request = ops_.make_goal_request(id, goal);
  const auto self = std::static_pointer_cast<ActionClientImpl>(shared_from_this());
  const auto impl = std::make_shared<ClientGoalImpl>(self, id);
  impl->callbacks = std::move(callbacks);
  std::int64_t sequence = 0;
  const std::lock_guard lock(mutex_);  // the response may arrive before the call returns
  check_rcl(rcl_action_send_goal_request(&client_, request.get(), &sequence), name_, "cannot send a goal");
  unanswered_.emplace(sequence, impl);
  goals_.emplace(id, impl);
  return id;
}

void ActionClientImpl::abandon(const GoalUUID & id) noexcept
{
  bool accepted = false;
  {
    const std::lock_guard lock(mutex_);
    const auto found = goals_.find(id);
    if (found == goals_.end()) {
      return;
    }
    found->second->abandoned = true;
    accepted = found->second->status.load() != GoalStatus::unknown;
  }
  try {
    if (accepted) {
      cancel(id, 0);
    }
  } catch (const std::exception & error) {
    RCL_CXX_WARN(node()->get_logger(), "{}: goal {} cannot be canceled: {}", name_, id.short_string(),
                 error.what());
  }
}

std::future<CancelResponse> ActionClientImpl::cancel(const GoalUUID & id, std::int64_t stamp_ns)
{
  action_msgs::srv::CancelGoal::Request request;
  request.goal_info.goal_id.uuid = id.bytes;
  request.goal_info.stamp = to_time(stamp_ns);
  std::promise<CancelResponse> promise;
  auto future = promise.get_future();
  std::int64_t sequence = 0;
  const std::lock_guard lock(mutex_);
  if (retired_) {
    throw Error(fmt::format("goal {} cannot be canceled: its action client is gone", id.short_string()));
  }
  check_rcl(rcl_action_send_cancel_request(&client_, &request, &sequence), name_,
            "cannot send a cancel request");
  cancellations_.emplace(sequence, std::move(promise));
  return future;
}

ActionClientImpl::Goal ActionClientImpl::find(const GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = goals_.find(id);
  return found == goals_.end() ? nullptr : found->second;
}

void ActionClientImpl::execute(std::size_t source)
{
  switch (source) {
    case kGoal:
      return take_goal_response();
    case kCancel:
      return take_cancel_response();
    case kResult:
      return take_result_response();
    case kFeedback:
      return take_feedback();
    default:
      return take_status();
  }
}

void ActionClientImpl::take_goal_response()
{
  const std::shared_ptr<void> response = make_message(ops_.type.goal_response);
  rmw_request_id_t id;
  if (!taken(rcl_action_take_goal_response(&client_, &id, response.get()), name_, "a goal response")) {
    return;
  }
  Goal goal;
  {
    const std::lock_guard lock(mutex_);
    if (auto node = unanswered_.extract(id.sequence_number)) {
      goal = std::move(node.mapped());
    }
  }
  if (!goal) {
    return;
  }
  if (ops_.accepted(response.get())) {
    on_accepted(goal);
  } else {
    on_rejected(goal);
  }
}

void ActionClientImpl::on_accepted(const Goal & goal)
{
  decltype(goal->callbacks.response) respond;
  bool abandoned = false;
  {
    const std::lock_guard lock(mutex_);
    GoalStatus unknown = GoalStatus::unknown;  // unless a status message has arrived earlier
    goal->status.compare_exchange_strong(unknown, GoalStatus::accepted);
    abandoned = goal->abandoned;
    respond = std::exchange(goal->callbacks.response, nullptr);
    const std::shared_ptr<void> request = ops_.make_result_request(goal->id());
    std::int64_t sequence = 0;
    check_rcl(rcl_action_send_result_request(&client_, request.get(), &sequence), name_,
              "cannot request a result");
    without_result_.emplace(sequence, goal);
  }
  if (abandoned) {
    cancel(goal->id(), 0);
  } else {
    respond(goal);
  }
}

void ActionClientImpl::on_rejected(const Goal & goal)
{
  ErasedGoalCallbacks callbacks;
  {
    const std::lock_guard lock(mutex_);
    callbacks = std::exchange(goal->callbacks, {});
    goals_.erase(goal->id());
  }
  if (!goal->abandoned) {
    callbacks.response(nullptr);
  }
}

void ActionClientImpl::take_cancel_response()
{
  action_msgs::srv::CancelGoal::Response response;
  rmw_request_id_t id;
  if (!taken(rcl_action_take_cancel_response(&client_, &id, &response), name_, "a cancel response")) {
    return;
  }
  CancelResponse result;
  result.code = static_cast<CancelCode>(response.return_code);
  for (const auto & info : response.goals_canceling) {
    result.goals.push_back(GoalUUID{info.goal_id.uuid});
  }
  const std::lock_guard lock(mutex_);
  if (auto node = cancellations_.extract(id.sequence_number)) {
    node.mapped().set_value(std::move(result));
  }
}

void ActionClientImpl::take_result_response()
{
  const std::shared_ptr<void> response = make_message(ops_.type.result_response);
  rmw_request_id_t id;
  if (!taken(rcl_action_take_result_response(&client_, &id, response.get()), name_, "a result")) {
    return;
  }
  Goal goal;
  ErasedGoalCallbacks callbacks;
  {
    const std::lock_guard lock(mutex_);
    auto node = without_result_.extract(id.sequence_number);
    if (!node) {
      return;
    }
    goal = std::move(node.mapped());
    goals_.erase(goal->id());
    callbacks = std::exchange(goal->callbacks, {});
    goal->status = static_cast<GoalStatus>(ops_.status(response.get()));
  }
  if (callbacks.result) {
    callbacks.result(goal->id(), response.get());
  }
}

void ActionClientImpl::take_feedback()
{
  const std::shared_ptr<void> message = make_message(ops_.type.feedback_message);
  if (!taken(rcl_action_take_feedback(&client_, message.get()), name_, "feedback")) {
    return;
  }
  decltype(ErasedGoalCallbacks::feedback) callback;  // a copy: it may destroy the client
  {
    const std::lock_guard lock(mutex_);
    const auto found = goals_.find(ops_.goal_id_of_feedback(message.get()));
    if (found != goals_.end() && !found->second->abandoned) {
      callback = found->second->callbacks.feedback;
    }
  }
  if (callback) {
    callback(message.get());
  }
}

void ActionClientImpl::take_status()
{
  action_msgs::msg::GoalStatusArray message;
  if (!taken(rcl_action_take_status(&client_, &message), name_, "the status of the goals")) {
    return;
  }
  for (const auto & entry : message.status_list) {
    const auto status = static_cast<GoalStatus>(entry.status);
    const Goal goal = find(GoalUUID{entry.goal_info.goal_id.uuid});
    if (goal && !is_terminal(status)) {  // the terminal status arrives with the result
      goal->status = status;
    }
  }
}

}  // namespace rcl_cxx::detail
