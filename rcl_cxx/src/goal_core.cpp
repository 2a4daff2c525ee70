#include "goal_core.hpp"

#include "action_server_core.hpp"
#include "node_core.hpp"
#include "rcl_error.hpp"

namespace rcl_cxx {
namespace detail {
GoalCore::GoalCore(std::weak_ptr<ActionServerCore> server, GoalId id,
                   const rcl_action_goal_handle_t & rcl_handle)
    : server_(std::move(server)), id_(id), rcl_handle_(rcl_handle)
{
  rcl_action_goal_info_t info = rcl_action_get_zero_initialized_goal_info();
  if (rcl_action_goal_handle_get_info(&rcl_handle_, &info) == RCL_RET_OK) {
    accepted_ns_ = std::int64_t{info.stamp.sec} * 1'000'000'000 + info.stamp.nanosec;
  } else {
    rcl_reset_error();
  }
}

GoalCore::~GoalCore()
{
  ignore_rcl(rcl_action_goal_handle_fini(&rcl_handle_));
}

bool GoalCore::update(rcl_action_goal_event_t event)
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

GoalHandleBase::GoalHandleBase(std::shared_ptr<detail::GoalCore> core) : core_(std::move(core)) {}

GoalHandleBase::~GoalHandleBase()
{
  if (const auto server = core_->server()) {
    server->on_handle_dropped(*core_);
  }
}

const GoalId & GoalHandleBase::goal_id() const noexcept
{
  return core_->id();
}

GoalStatus GoalHandleBase::status() const noexcept
{
  return core_->status();
}

bool GoalHandleBase::is_active() const noexcept
{
  return !is_terminal(status());
}

bool GoalHandleBase::is_canceling() const noexcept
{
  return status() == GoalStatus::canceling;
}

std::int64_t GoalHandleBase::accepted_ns() const noexcept
{
  return core_->accepted_ns();
}

bool GoalHandleBase::finish(GoalStatus status, std::shared_ptr<void> result_response) noexcept
{
  const auto server = core_->server();
  return server && server->finish(*core_, status, std::move(result_response));
}

bool GoalHandleBase::send_feedback(void * feedback_message) noexcept
{
  const auto server = core_->server();
  return server && server->publish_feedback(*core_, feedback_message);
}

void GoalHandleBase::report_exception(const char * what) const noexcept
{
  if (const auto server = core_->server()) {
    RCL_CXX_ERROR(server->node()->logger(), "{}: goal {}: {}", server->action_name(),
                  goal_id().short_string(), what);
  }
}

}  // namespace rcl_cxx
