#include "action/action_server_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "action/action_announcement.hpp"
#include "action/action_messages.hpp"
#include "events/event_queue.hpp"
#include "executor/timer_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_compat.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/type_support.hpp"

namespace rcl_cxx {
namespace detail {
namespace {

// "For ever", but small enough that rcl can add it to the time of day.
constexpr std::int64_t kCenturyNs = 100LL * 365 * 24 * 3600 * 1'000'000'000;

// A client usually requests the result as soon as its goal is accepted.
constexpr std::chrono::milliseconds kResultRequestLimit{250};

// rcl_action expires a goal when its age, in ROS time, exceeds the timeout.
constexpr std::chrono::milliseconds kExpirySlack{5};
constexpr std::chrono::milliseconds kFirstExpiryRetry{20};
constexpr std::chrono::seconds kLongestExpiryRetry{1};

// A graph query takes 28 us with 93 actions and one client each.
constexpr std::chrono::milliseconds kClientCheckPeriod{50};
}  // namespace

ActionServerImpl::ActionServerImpl(std::shared_ptr<NodeImpl> node, const ActionType & type,
                                   const std::string & name, ActionServerCallbacks callbacks,
                                   const ActionServerOptions & options)
    : Waitable(std::move(node), fmt::format("action server {}", name)),
      type_(type),
      type_support_(*type.type_support()),
      callbacks_(std::move(callbacks)),
      goal_group_(options.goal_callback_group ? options.goal_callback_group : this->node()->default_group()),
      cancel_group_(options.cancel_callback_group ? options.cancel_callback_group
                                                  : this->node()->default_group()),
      sender_(std::make_shared<ResponseSender>(this->node(), cancel_group_))
{
  rcl_action_server_options_t rcl_options = rcl_action_server_get_default_options();
  if (options.result_timeout) {
    const std::int64_t ns = options.result_timeout->count();
    rcl_options.result_timeout.nanoseconds = ns < 0 ? kCenturyNs : ns;
  }
  result_timeout_ = std::chrono::nanoseconds(rcl_options.result_timeout.nanoseconds);
  NodeImpl & owner = *this->node();
  name_ = owner.resolve(name, false);
  const auto lock = owner.lock_to_create(label());
  const auto no_jump = owner.get_clock().lock();
  check_rcl(compat::timer_init_canceled(&rcl_timer_, owner.get_clock().handle(), owner.get_context().handle(),
                                        kCenturyNs),
            label(), "cannot create a timer");
  const rcl_ret_t code =
      compat::action_server_init(&server_, owner.handle(), &rcl_timer_, owner.get_clock().handle(),
                                 type_support_.get(), name_.c_str(), &rcl_options);
  if (code != RCL_RET_OK) {
    const std::string reason = take_rcl_error();
    ignore_rcl(rcl_timer_fini(&rcl_timer_));
    throw Error(fmt::format("{}: cannot be created (rcl error {}: {})", label(), code, reason), code);
  }
  reset_type_support_error();
}

ActionServerImpl::~ActionServerImpl()
{
  const std::lock_guard lock(node()->mutex());
  const auto no_jump = node()->get_clock().lock();
  ignore_rcl(rcl_action_server_fini(&server_, node()->handle()));
  ignore_rcl(rcl_timer_fini(&rcl_timer_));
}

void ActionServerImpl::set_on_ready_callbacks()
{
  const std::weak_ptr<ActionServerImpl> weak = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  const auto make_timer = [&](std::chrono::nanoseconds period, void (ActionServerImpl::*callback)()) {
    auto timer = make_waitable<TimerImpl>(
        node(), period,
        [weak, callback] {
          if (const auto self = weak.lock()) {
            ((*self).*callback)();
          }
        },
        cancel_group_);
    timer->cancel();
    return timer;
  };
  expiry_timer_ = make_timer(std::chrono::hours(1), &ActionServerImpl::expire_goals);
  if (callbacks_.on_client_lost) {
    client_timer_ = make_timer(kClientCheckPeriod, &ActionServerImpl::check_clients);
  }
  shutdown_callback_ = node()->get_context().add_callback(ContextImpl::Phase::action_servers, [weak] {
    if (const auto self = weak.lock()) {
      self->abort_all("shutdown", self->cancel_group_->pending_events().in_own_callback());
    }
  });
  set_callback(rcl_action_server_set_goal_service_callback, server_, kGoal);
  set_callback(rcl_action_server_set_cancel_service_callback, server_, kCancel);
  set_callback(rcl_action_server_set_result_service_callback, server_, kResult);
}

void ActionServerImpl::clear_on_ready_callbacks() noexcept
{
  clear_callback(rcl_action_server_set_goal_service_callback, server_);
  clear_callback(rcl_action_server_set_cancel_service_callback, server_);
  clear_callback(rcl_action_server_set_result_service_callback, server_);
  for (const auto & timer : {expiry_timer_, client_timer_}) {
    if (timer) {
      timer->close();
    }
  }
}

void ActionServerImpl::execute(std::size_t source)
{
  switch (source) {
    case kGoal:
      return take_goal();
    case kCancel:
      return take_cancel();
    case kDeferredResponse:
      return send_deferred_response();
    default:
      take_result();
  }
}

const CallbackGroup & ActionServerImpl::group(std::size_t source) const
{
  return source == kCancel || source == kResult ? *cancel_group_ : *goal_group_;
}

std::shared_ptr<ServerGoalImpl> ActionServerImpl::find(const GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = goals_.find(id);
  return found == goals_.end() ? nullptr : found->second;
}

ActionServerImpl::Goals ActionServerImpl::get_active_goals() const
{
  Goals active;
  const std::lock_guard lock(mutex_);
  for (const auto & [id, goal] : goals_) {
    if (!is_terminal(goal->get_status())) {
      active.push_back(goal);
    }
  }
  return active;
}

std::shared_ptr<void> ActionServerImpl::make_empty_result(const GoalUUID & id, GoalStatus status) const
{
  std::shared_ptr<void> response = make_message(type_.result_response);
  type_.set_status(response.get(), status);
  if (callbacks_.fill_missing_result) {
    call("fill_missing_result", id,
         [&] { callbacks_.fill_missing_result(status, type_.get_result(response.get())); });
  }
  return response;
}

void ActionServerImpl::abort_all(const char * reason, bool take_requests) noexcept
{
  reject_deferred_goals(reason);
  try {
    Goals goals = get_active_goals();
    std::erase_if(goals, [this](const auto & goal) {
      return !try_to_finish(*goal, GoalStatus::aborted, make_empty_result(goal->id(), GoalStatus::aborted));
    });
    if (!goals.empty()) {
      RCL_CXX_WARN(node()->get_logger(), "{}: {}, {} active goals aborted", name_, reason, goals.size());
    }
    wait_for_result_requests(take_requests);
  } catch (const std::exception & error) {
    RCL_CXX_WARN(node()->get_logger(), "{}: {}", name_, error.what());
  }
}

/// Of goals that have just ended: their clients may not yet know that they were accepted.
bool ActionServerImpl::expects_result_requests() const
{
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  return std::any_of(goals_.begin(), goals_.end(), [&](const auto & entry) {
    const ServerGoalImpl & goal = *entry.second;
    return is_terminal(goal.get_status()) && !goal.result_sent && now - goal.ended < kResultRequestLimit;
  });
}

void ActionServerImpl::wait_for_result_requests(bool take_requests)
{
  while (expects_result_requests()) {
    if (!take_requests || !take_result()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

void ActionServerImpl::retire() noexcept
{
  node()->get_context().remove_callback(shutdown_callback_);
  close();
  sender_->stop();
  abort_all("the action server was destroyed", true);
  // Handles may find this server for a moment: the executor's thread may hold a reference.
  const std::lock_guard lock(mutex_);
  for (const auto & [id, goal] : goals_) {
    if (!is_terminal(goal->get_status())) {
      goal->orphan();  // aborting it has failed
    }
  }
  retired_ = true;
}

bool ActionServerImpl::publish_feedback(const ServerGoalImpl & goal, void * message) noexcept
{
  // Under the lock, so that no feedback follows the result.
  const std::lock_guard lock(mutex_);
  if (retired_ || is_terminal(goal.get_status())) {
    return false;
  }
  if (guard_serialization([&] { return rcl_action_publish_feedback(&server_, message); }) == RCL_RET_OK) {
    return true;
  }
  if (node()->get_context().ok()) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: feedback cannot be published: {}", name_,
                  goal.id().short_string(), take_rcl_error());
  }
  rcl_reset_error();
  return false;
}

void ActionServerImpl::abort(ServerGoalImpl & goal) noexcept
{
  try {
    try_to_finish(goal, GoalStatus::aborted, make_empty_result(goal.id(), GoalStatus::aborted));
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {} cannot be aborted: {}", name_, goal.id().short_string(),
                  error.what());
  }
}

void ActionServerImpl::on_handle_dropped(ServerGoalImpl & goal) noexcept
{
  {
    const std::lock_guard lock(mutex_);
    if (retired_ || is_terminal(goal.get_status())) {
      return;
    }
  }
  RCL_CXX_ERROR(node()->get_logger(), "{}: goal {} aborted: its handle was released without a result", name_,
                goal.id().short_string());
  abort(goal);
}

bool ActionServerImpl::finish(ServerGoalImpl & goal, GoalStatus status,
                              std::shared_ptr<void> result_response) noexcept
{
  try {
    if (try_to_finish(goal, status, std::move(result_response))) {
      return true;
    }
    const std::lock_guard lock(mutex_);
    if (retired_) {
      return false;
    }
    RCL_CXX_WARN(node()->get_logger(), "{}: goal {} is {}, it cannot become {}", name_,
                 goal.id().short_string(), to_string(goal.get_status()), to_string(status));
  } catch (const std::exception & error) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: {}", name_, goal.id().short_string(), error.what());
  }
  return false;
}

bool ActionServerImpl::transition_locked(ServerGoalImpl & goal, GoalStatus status)
{
  switch (status) {
    case GoalStatus::succeeded:
      return goal.update(GOAL_EVENT_SUCCEED);
    case GoalStatus::aborted:
      return goal.update(GOAL_EVENT_ABORT);
    case GoalStatus::canceled:
      // The goal's thread may finish it before handle_cancel has returned.
      if (goal.in_handle_cancel && goal.get_status() == GoalStatus::executing) {
        goal.update(GOAL_EVENT_CANCEL_GOAL);
      }
      return goal.update(GOAL_EVENT_CANCELED);
    default:
      return false;
  }
}

bool ActionServerImpl::try_to_finish(ServerGoalImpl & goal, GoalStatus status,
                                     std::shared_ptr<void> result_response)
{
  std::vector<rmw_request_id_t> requests;
  {
    const std::lock_guard lock(mutex_);
    if (retired_ || is_terminal(goal.get_status()) || !transition_locked(goal, status)) {
      return false;
    }
    goal.result_response = std::move(result_response);
    goal.ended = std::chrono::steady_clock::now();
    requests.swap(goal.result_requests);
  }
  for (const rmw_request_id_t & request : requests) {
    send_result(request, goal);
  }
  const std::lock_guard lock(mutex_);
  publish_status_locked();
  ignore_rcl(rcl_action_notify_goal_done(&server_));
  if (result_timeout_.count() < kCenturyNs && expiry_timer_->is_canceled()) {
    schedule_expiry_locked();
  }
  return true;
}

void ActionServerImpl::publish_status_locked()
{
  rcl_action_goal_status_array_t status = rcl_action_get_zero_initialized_goal_status_array();
  rcl_ret_t code = rcl_action_get_goal_status_array(&server_, &status);
  if (code == RCL_RET_OK) {
    action_msgs::msg::GoalStatusArray message = to_cpp(status.msg);
    code = rcl_action_publish_status(&server_, &message);
  }
  if (code != RCL_RET_OK && node()->get_context().ok()) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: the status of the goals cannot be published: {}", name_,
                  take_rcl_error());
  }
  rcl_reset_error();
  ignore_rcl(rcl_action_goal_status_array_fini(&status));
}

void ActionServerImpl::expire_goals()
{
  Goals expired;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  while (true) {
    rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
    std::size_t count = 0;
    check_rcl(rcl_action_expire_goals(&server_, &info, 1, &count), name_, "goals cannot expire");
    if (count == 0) {
      break;
    }
    if (auto node = goals_.extract(to_goal_id(info))) {
      expired.push_back(std::move(node.mapped()));
    }
  }
  if (!expired.empty()) {
    publish_status_locked();
  }
  schedule_expiry_locked();
}

void ActionServerImpl::schedule_expiry_locked()
{
  constexpr auto never = std::chrono::steady_clock::time_point::max();
  auto first_end = never;
  for (const auto & [id, goal] : goals_) {
    if (is_terminal(goal->get_status())) {
      first_end = std::min(first_end, goal->ended);
    }
  }
  if (first_end == never) {
    return;
  }
  // A goal may be overdue by this clock and not have expired by ROS time.
  const std::chrono::nanoseconds left =
      first_end + result_timeout_ + kExpirySlack - std::chrono::steady_clock::now();
  const auto retry = std::clamp<std::chrono::nanoseconds>(-left, kFirstExpiryRetry, kLongestExpiryRetry);
  expiry_timer_->call_once_in(std::max<std::chrono::nanoseconds>(left, retry));
}
}  // namespace detail

ActionServer::ActionServer(std::shared_ptr<detail::NodeImpl> node, const ActionType & type,
                           const std::string & action, ActionServerCallbacks callbacks,
                           const ActionServerOptions & options)
{
  if (!callbacks.handle_accepted) {
    throw Error(fmt::format("action server {}: the callback handle_accepted is missing", action));
  }
  if (options.creation_callback_group && detail::compat::reports_subscriptions) {
    announcement_ = detail::make_waitable<detail::ActionAnnouncement>(std::move(node), type, action,
                                                                      std::move(callbacks), options);
  } else {
    impl_ = detail::make_waitable<detail::ActionServerImpl>(std::move(node), type, action,
                                                            std::move(callbacks), options);
  }
}

ActionServer::~ActionServer()
{
  if (announcement_) {
    announcement_->retire();
  } else {
    impl_->retire();
  }
}

}  // namespace rcl_cxx
