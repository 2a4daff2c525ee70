#include "rcl_cxx/server_goal_handle.hpp"

#include "action/action_server_impl.hpp"
#include "node/node_impl.hpp"

namespace rcl_cxx {

std::shared_ptr<void> make_message(const MessageType & type)
{
  return {type.create(), type.destroy};
}

ServerGoalHandle::ServerGoalHandle(std::shared_ptr<detail::ServerGoalImpl> impl, const ActionType & type,
                                   std::shared_ptr<const void> goal_request)
    : impl_(std::move(impl)),
      type_(type),
      goal_request_(std::move(goal_request)),
      feedback_message_(make_message(type.feedback_message))
{
  type_.set_goal_id(feedback_message_.get(), get_goal_id());
}

ServerGoalHandle::~ServerGoalHandle()
{
  if (const auto server = impl_->server()) {
    server->on_handle_dropped(*impl_);
  }
}

const void * ServerGoalHandle::get_goal() const noexcept
{
  return type_.get_goal(goal_request_.get());
}

const GoalUUID & ServerGoalHandle::get_goal_id() const noexcept
{
  return impl_->id();
}

GoalStatus ServerGoalHandle::get_status() const noexcept
{
  return impl_->get_status();
}

bool ServerGoalHandle::is_active() const noexcept
{
  return !is_terminal(get_status());
}

bool ServerGoalHandle::is_canceling() const noexcept
{
  return get_status() == GoalStatus::canceling;
}

std::int64_t ServerGoalHandle::get_goal_stamp() const noexcept
{
  return impl_->get_goal_stamp();
}

void ServerGoalHandle::keep_watching_client() noexcept
{
  impl_->watches_beyond_end = true;
}

bool ServerGoalHandle::publish_feedback(const void * feedback) noexcept
{
  const auto server = impl_->server();
  if (!server) {
    return false;
  }
  try {
    const std::lock_guard lock(feedback_mutex_);
    type_.copy_feedback(feedback_message_.get(), feedback);
    return server->publish_feedback(*impl_, feedback_message_.get());
  } catch (const std::exception & error) {
    log_exception(error.what());
    return false;
  }
}

bool ServerGoalHandle::finish(GoalStatus status, const void * result) noexcept
{
  const auto server = impl_->server();
  if (!server) {
    return false;
  }
  try {
    auto response = make_message(type_.result_response);
    type_.set_status(response.get(), status);
    type_.copy_result(response.get(), result);
    return server->finish(*impl_, status, std::move(response));
  } catch (const std::exception & error) {
    log_exception(error.what());
    return false;
  }
}

void ServerGoalHandle::log_exception(const char * what) const noexcept
{
  if (const auto server = impl_->server()) {
    RCL_CXX_ERROR(server->node()->get_logger(), "{}: goal {}: {}", server->get_action_name(),
                  get_goal_id().short_string(), what);
  }
}

}  // namespace rcl_cxx
