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

}  // namespace rcl_cxx
