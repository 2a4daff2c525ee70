#include "ur_ros_rtde/detail/goal.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/plugin_host.hpp"

namespace ur_ros_rtde {

std::string with_code(const Error & error)
{
  return fmt::format("{} ({} {})", error.message, to_string(error.code), static_cast<int>(error.code));
}

Goal::Goal(PluginHost & host, std::string action, const rcl_cxx::GoalUUID & id)
    : host_(host), action_(std::move(action)), id_(id)
{
}

std::string Goal::name() const
{
  return fmt::format("{} {}", action_, id_.short_string());
}

void Goal::accept(std::shared_ptr<Handle> handle)
{
  const std::lock_guard lock(mutex_);
  handle_ = std::move(handle);
  accepted_ = true;
}

void Goal::run()
{
  finish(guarded([this] { return execute(); }), false);
}

void Goal::stop(const Error & why)
{
  const std::lock_guard lock(mutex_);
  if (!stop_request_->request(why)) {
    const bool has_less_time = why.code == ErrorCode::shutdown || why.code == ErrorCode::preempted;
    if (accepted_ && has_less_time && stop_request_->reason()->code != ErrorCode::shutdown) {
      on_stop(why);
    }
    return;
  }
  if (!accepted_) {
    release();  // it ends as soon as it is accepted
    return;
  }
  on_stop(why);
  host_.goals().supervise(shared_from_this());
}

void Goal::abandon()
{
  const Error why = stop_request_->reason().value_or(Error{ErrorCode::timeout, "the goal did not end"});
  stop_request_->abandon();
  const Status at_rest = stopped().value_or(Status());
  end(Error{why.code,
            fmt::format("{}; the command did not return after that: its result was sent without it, and {}",
                        why.message,
                        at_rest ? "it can no longer move the arm"
                                : "standstill is not confirmed: " + at_rest.error().message)});
}

void Goal::end(const Outcome & outcome)
{
  finish(outcome, true);
}

void Goal::finish(const Outcome & outcome, bool abandoned)
{
  if (finished_.exchange(true)) {
    warn("its command has returned after its result was sent");
    return;
  }
  release();
  log(outcome);
  send_result(outcome, abandoned);
}

void Goal::send(const Outcome & outcome, const void * result)
{
  if (outcome) {
    handle_->succeed(result);
  } else if (outcome.code() == ErrorCode::canceled && handle_->is_canceling()) {
    handle_->canceled(result);
  } else {
    handle_->abort(result);
  }
}

void Goal::log(const Outcome & outcome) const
{
  const auto & logger = host_.node().get_logger();
  if (outcome) {
    RCL_CXX_INFO(logger, "{}: goal {} succeeded{}{}", action_, id_.short_string(),
                 outcome.message().empty() ? "" : ": ", outcome.message());
    return;
  }
  const std::string end =
      fmt::format("{}: goal {} ended: {}", action_, id_.short_string(), with_code(outcome.error()));
  const auto why = stop_request_->reason();
  // Nothing went wrong beyond the shutdown, which would add to the message.
  if (why && why->code == ErrorCode::shutdown && outcome.message() == why->message) {
    RCL_CXX_INFO(logger, "{}", end);
  } else {
    RCL_CXX_WARN(logger, "{}", end);
  }
}

void Goal::warn(const std::string & text) const
{
  RCL_CXX_WARN(host_.node().get_logger(), "{}: goal {}: {}", action_, id_.short_string(), text);
}

}  // namespace ur_ros_rtde
