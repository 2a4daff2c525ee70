#include "action_server_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "action_messages.hpp"
#include "node_impl.hpp"
#include "qos_rmw.hpp"
#include "rcl_compat.hpp"
#include "rcl_error.hpp"
#include "timer_impl.hpp"

namespace rcl_cxx::detail {
namespace {
// "For ever", and yet small enough that rcl can add it to the time of day.
constexpr std::int64_t kCenturyNs = 100LL * 365 * 24 * 3600 * 1'000'000'000;

// A client asks for the result as soon as it knows that its goal is accepted. It need not, though.
constexpr std::chrono::milliseconds kGraceForRequests{250};

// rcl compares "later than the timeout", in ROS time: a look exactly at it would come to nothing.
constexpr std::chrono::milliseconds kExpirySlack{5};
constexpr std::chrono::milliseconds kExpiryRetry{20};

// A look at the graph takes 28 us beside 93 actions and a client of each.
constexpr std::chrono::milliseconds kClientCheckPeriod{50};

rcl_action_server_options_t to_rcl(const ActionServerOptions & options)
{
  rcl_action_server_options_t result = rcl_action_server_get_default_options();
  result.goal_service_qos = to_rmw(options.goal_service_qos);
  result.cancel_service_qos = to_rmw(options.cancel_service_qos);
  result.result_service_qos = to_rmw(options.result_service_qos);
  result.feedback_topic_qos = to_rmw(options.feedback_qos);
  result.status_topic_qos = to_rmw(options.status_qos);
  if (options.result_timeout) {
    const std::int64_t ns = options.result_timeout->count();
    result.result_timeout.nanoseconds = ns < 0 ? kCenturyNs : ns;
  }
  return result;
}
}  // namespace

ExpireTimer::ExpireTimer(NodeImpl & node) : timer_(rcl_get_zero_initialized_timer())
{
  check_rcl(compat::timer_init_canceled(&timer_, node.get_clock().handle(), node.get_context().handle(),
                                        kCenturyNs),
            "timer", "cannot be created");
}

ExpireTimer::~ExpireTimer()
{
  ignore_rcl(rcl_timer_fini(&timer_));
}

std::shared_ptr<ActionServerImpl> ActionServerImpl::create(std::shared_ptr<NodeImpl> node,
                                                           ErasedActionServer erased,
                                                           const std::string & name,
                                                           const ActionServerOptions & options)
{
  if (!erased.accepted) {
    throw Error(fmt::format("action server {}: without a handler of accepted goals", name));
  }
  auto impl = std::make_shared<ActionServerImpl>(std::move(node), std::move(erased), name, options);
  impl->start();
  return impl;
}

ActionServerImpl::ActionServerImpl(std::shared_ptr<NodeImpl> node, ErasedActionServer erased,
                                   const std::string & name, const ActionServerOptions & options)
    : Waitable(std::move(node), fmt::format("action server {}", name)),
      erased_(std::move(erased)),
      ops_(*erased_.ops),
      answers_(std::make_shared<ResponseRetry>(this->node())),
      server_(rcl_action_get_zero_initialized_server())
{
  const rcl_action_server_options_t rcl_options = to_rcl(options);
  result_timeout_ = std::chrono::nanoseconds(rcl_options.result_timeout.nanoseconds);
  results_expire_ = result_timeout_.count() < kCenturyNs;
  name_ = this->node()->resolve(name, false);
  const std::lock_guard lock(this->node()->mutex());
  rcl_timer_ = std::make_unique<ExpireTimer>(*this->node());
  check_rcl(compat::action_server_init(&server_, this->node()->handle(), rcl_timer_->get(),
                                       this->node()->get_clock().handle(), ops_.type_support(), name.c_str(),
                                       &rcl_options),
            label(), "cannot be created");
}

ActionServerImpl::~ActionServerImpl()
{
  const std::lock_guard lock(node()->mutex());
  ignore_rcl(rcl_action_server_fini(&server_, node()->handle()));
}

void ActionServerImpl::start()
{
  const std::weak_ptr<ActionServerImpl> weak = std::static_pointer_cast<ActionServerImpl>(shared_from_this());
  const auto create_timer = [&](std::chrono::nanoseconds period, void (ActionServerImpl::*callback)()) {
    auto timer = TimerImpl::create(node(), period, [weak, callback] {
      if (const auto self = weak.lock()) {
        ((*self).*callback)();
      }
    });
    timer->cancel();
    return timer;
  };
  expiry_ = create_timer(std::chrono::hours(1), &ActionServerImpl::expire);
  if (erased_.client_lost) {
    client_check_ = create_timer(kClientCheckPeriod, &ActionServerImpl::check_clients);
  }
  shutdown_callback_ = node()->get_context().add_callback(ContextImpl::Phase::library_before, [weak] {
    if (const auto self = weak.lock()) {
      self->abort_all("shutdown", self->node()->in_own_callback());
    }
  });
  check_rcl(rcl_action_server_set_goal_service_callback(&server_, &on_event, source(kGoal)), label(),
            "its middleware does not report new goals");
  check_rcl(rcl_action_server_set_cancel_service_callback(&server_, &on_event, source(kCancel)), label(),
            "its middleware does not report requests to cancel");
  check_rcl(rcl_action_server_set_result_service_callback(&server_, &on_event, source(kResult)), label(),
            "its middleware does not report requests for results");
}

void ActionServerImpl::stop() noexcept
{
  ignore_rcl(rcl_action_server_set_goal_service_callback(&server_, nullptr, nullptr));
  ignore_rcl(rcl_action_server_set_cancel_service_callback(&server_, nullptr, nullptr));
  ignore_rcl(rcl_action_server_set_result_service_callback(&server_, nullptr, nullptr));
  for (const auto & timer : {expiry_, client_check_}) {
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

std::size_t ActionServerImpl::active_goal_count() const
{
  const std::lock_guard lock(mutex_);
  std::size_t count = 0;
  for (const auto & [id, goal] : goals_) {
    count += is_terminal(goal->get_status()) ? 0 : 1;
  }
  return count;
}

std::shared_ptr<ServerGoalImpl> ActionServerImpl::find(const GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = goals_.find(id);
  return found == goals_.end() ? nullptr : found->second;
}

std::shared_ptr<void> ActionServerImpl::missing_result(GoalStatus status) const
{
  std::shared_ptr<void> response = ops_.make_result_response(status);
  if (erased_.missing_result) {
    erased_.missing_result(status, response.get());
  }
  return response;
}

void ActionServerImpl::abort_all(const char * why, bool serve) noexcept
{
  reject_deferred_goals(why);
  std::vector<std::shared_ptr<ServerGoalImpl>> aborted;
  {
    const std::lock_guard lock(mutex_);
    for (const auto & [id, goal] : goals_) {
      if (!is_terminal(goal->get_status()) &&
          finish_locked(*goal, GoalStatus::aborted, missing_result(GoalStatus::aborted))) {
        aborted.push_back(goal);
      }
    }
  }
  if (aborted.empty()) {
    return;
  }
  RCL_CXX_WARN(node()->get_logger(), "{}: goals aborted that were running: {} ({})", name_, aborted.size(),
               why);
  try {
    await_requests(aborted, serve);
  } catch (const std::exception & error) {
    RCL_CXX_WARN(node()->get_logger(), "{}: {}", name_, error.what());
  }
}

void ActionServerImpl::await_requests(const std::vector<std::shared_ptr<ServerGoalImpl>> & goals, bool serve)
{
  const auto deadline = std::chrono::steady_clock::now() + kGraceForRequests;
  const auto sent = [](const std::shared_ptr<ServerGoalImpl> & goal) { return goal->result_sent.load(); };
  while (!std::all_of(goals.begin(), goals.end(), sent) && std::chrono::steady_clock::now() < deadline) {
    if (!serve || !take_result()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

void ActionServerImpl::retire() noexcept
{
  node()->get_context().remove_callback(shutdown_callback_);
  close();
  answers_->stop();
  abort_all("the action server was destroyed", true);
  // Handles may find this for a moment yet: the executor's thread may hold it.
  const std::lock_guard lock(mutex_);
  for (const auto & [id, goal] : goals_) {
    if (!is_terminal(goal->get_status())) {
      goal->orphan();  // its abortion has failed
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
  if (rcl_action_publish_feedback(&server_, message) != RCL_RET_OK) {
    if (node()->get_context().ok()) {
      RCL_CXX_ERROR(node()->get_logger(), "{}: goal {}: feedback cannot be published: {}", name_,
                    goal.id().short_string(), take_rcl_error());
    }
    rcl_reset_error();
    return false;
  }
  return true;
}

void ActionServerImpl::on_handle_dropped(ServerGoalImpl & goal) noexcept
{
  const std::lock_guard lock(mutex_);
  if (!retired_ && !is_terminal(goal.get_status())) {
    RCL_CXX_ERROR(node()->get_logger(), "{}: goal {} was given up without a result, it is aborted", name_,
                  goal.id().short_string());
    finish_locked(goal, GoalStatus::aborted, missing_result(GoalStatus::aborted));
  }
}

bool ActionServerImpl::finish(ServerGoalImpl & goal, GoalStatus status,
                              std::shared_ptr<void> result_response) noexcept
{
  const std::lock_guard lock(mutex_);
  if (retired_) {
    return false;
  }
  if (finish_locked(goal, status, std::move(result_response))) {
    return true;
  }
  RCL_CXX_WARN(node()->get_logger(), "{}: goal {} is {}, it cannot become {}", name_,
               goal.id().short_string(), to_string(goal.get_status()), to_string(status));
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
      // A worker that is quick may be done before its cancel handler has returned.
      if (goal.cancel_being_decided && goal.get_status() == GoalStatus::executing) {
        goal.update(GOAL_EVENT_CANCEL_GOAL);
      }
      return goal.update(GOAL_EVENT_CANCELED);
    default:
      return false;
  }
}

bool ActionServerImpl::finish_locked(ServerGoalImpl & goal, GoalStatus status,
                                     std::shared_ptr<void> result_response)
{
  if (is_terminal(goal.get_status()) || !transition_locked(goal, status)) {
    return false;
  }
  goal.result_response = std::move(result_response);
  for (const rmw_request_id_t & request : goal.result_requests) {
    send_result(request, goal);
  }
  goal.result_requests.clear();
  publish_status_locked();
  ignore_rcl(rcl_action_notify_goal_done(&server_));
  goal.ended = std::chrono::steady_clock::now();
  if (results_expire_ && expiry_->is_canceled()) {
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

void ActionServerImpl::expire()
{
  std::vector<std::shared_ptr<ServerGoalImpl>> expired;  // destroyed after the lock is released
  const std::lock_guard lock(mutex_);
  while (true) {
    rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
    std::size_t count = 0;
    check_rcl(rcl_action_expire_goals(&server_, &info, 1, &count), name_, "goals cannot expire");
    if (count == 0) {
      break;
    }
    GoalUUID id;
    std::copy(std::begin(info.goal_id.uuid), std::end(info.goal_id.uuid), id.bytes.begin());
    if (auto node = goals_.extract(id)) {
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
  auto first_end = std::chrono::steady_clock::time_point::max();
  for (const auto & [id, goal] : goals_) {
    if (is_terminal(goal->get_status())) {
      first_end = std::min(first_end, goal->ended);
    }
  }
  if (first_end == std::chrono::steady_clock::time_point::max()) {
    return;
  }
  // It may be overdue by this clock and yet not expired: ROS time goes its own way.
  const std::chrono::nanoseconds left =
      first_end + result_timeout_ + kExpirySlack - std::chrono::steady_clock::now();
  expiry_->call_once_in(std::max<std::chrono::nanoseconds>(left, kExpiryRetry));
}

}  // namespace rcl_cxx::detail
