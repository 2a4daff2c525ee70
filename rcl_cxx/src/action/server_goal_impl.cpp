#include "action/server_goal_impl.hpp"

#include "action/action_server_impl.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/to_time.hpp"

namespace rcl_cxx {
namespace detail {
ServerGoalImpl::ServerGoalImpl(std::weak_ptr<ActionServerImpl> server, GoalUUID id,
                               const rcl_action_goal_handle_t & rcl_handle)
    : server_(std::move(server)), id_(id), rcl_handle_(rcl_handle)
{
  rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
  if (rcl_action_goal_handle_get_info(&rcl_handle_, &info) == RCL_RET_OK) {
    stamp_ = to_ns(info.stamp);
  } else {
    rcl_reset_error();
  }
}

ServerGoalImpl::~ServerGoalImpl()
{
  ignore_rcl(rcl_action_goal_handle_fini(&rcl_handle_));
}

bool ServerGoalImpl::update(rcl_action_goal_event_t event)
{
  if (rcl_action_update_goal_state(&rcl_handle_, event) != RCL_RET_OK) {
    rcl_reset_error();
    return false;
  }
  rcl_action_goal_state_t state = GOAL_STATE_UNKNOWN;
  if (rcl_action_goal_handle_get_status(&rcl_handle_, &state) == RCL_RET_OK) {
    status_ = static_cast<GoalStatus>(state);
  } else {
    rcl_reset_error();
  }
  return true;
}
}  // namespace detail

ServerGoalHandleBase::ServerGoalHandleBase(std::shared_ptr<detail::ServerGoalImpl> impl)
    : impl_(std::move(impl))
{
}

ServerGoalHandleBase::~ServerGoalHandleBase()
{
  if (const auto server = impl_->server()) {
    server->on_handle_dropped(*impl_);
  }
}

const GoalUUID & ServerGoalHandleBase::get_goal_id() const noexcept
{
  return impl_->id();
}

GoalStatus ServerGoalHandleBase::get_status() const noexcept
{
  return impl_->get_status();
}

bool ServerGoalHandleBase::is_active() const noexcept
{
  return !is_terminal(get_status());
}

bool ServerGoalHandleBase::is_canceling() const noexcept
{
  return get_status() == GoalStatus::canceling;
}

std::int64_t ServerGoalHandleBase::get_goal_stamp() const noexcept
{
  return impl_->get_goal_stamp();
}

bool ServerGoalHandleBase::finish(GoalStatus status, std::shared_ptr<void> result_response) noexcept
{
  const auto server = impl_->server();
  return server && server->finish(*impl_, status, std::move(result_response));
}

bool ServerGoalHandleBase::send_feedback(void * feedback_message) noexcept
{
  const auto server = impl_->server();
  return server && server->publish_feedback(*impl_, feedback_message);
}

void ServerGoalHandleBase::log_exception(const char * what) const noexcept
{
  if (const auto server = impl_->server()) {
    RCL_CXX_ERROR(server->node()->get_logger(), "{}: goal {}: {}", server->get_action_name(),
                  get_goal_id().short_string(), what);
  }
}

}  // namespace rcl_cxx
