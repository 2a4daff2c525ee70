#include "ur_ros_rtde/detail/active_goals.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {
namespace {
/// The goal was stopped by the shutdown, and nothing else went wrong (which would add to the message).
bool stopped_by_shutdown(const Outcome & outcome, const StopRequest & stop_request)
{
  const auto reason = stop_request.reason();
  return reason && reason->code == ErrorCode::shutdown && outcome.message() == reason->message;
}

/// "speed is 9 (invalid_goal 1)"
std::string with_code(const std::string & message, ErrorCode code)
{
  return fmt::format("{} ({} {})", message, to_string(code), static_cast<int>(code));
}
}  // namespace

StopReason client_lost()
{
  return Error{
      ErrorCode::client_lost,
      "the client that sent this goal has disappeared: keep the action client alive until the result is "
      "received, or start command_server with on_client_lost:=continue"};
}

Outcome missing_result(rcl_cxx::GoalStatus status)
{
  if (status == rcl_cxx::GoalStatus::unknown) {
    return Outcome::failure(ErrorCode::exception,
                            "this driver has no such goal: it has expired, or another driver with the same "
                            "names has accepted it");
  }
  return Outcome::failure(ErrorCode::exception,
                          "the goal ended without a result that can be sent: see the log of the driver");
}

tl::expected<void, std::string> ActiveGoals::accept(const rcl_cxx::GoalUUID & id,
                                                    const std::function<Status(GoalContext &)> & check)
{
  const auto context = std::make_shared<GoalContext>();
  const Outcome checked = guarded([&]() -> Outcome {
    const Status can_start = host_.goal_threads().can_start();
    return can_start ? check(*context) : can_start;
  });
  if (!checked) {
    return publish_refusal(id, checked.error());
  }
  const std::lock_guard lock(mutex_);
  contexts_[id] = context;
  return {};
}

std::shared_ptr<GoalContext> ActiveGoals::find(const rcl_cxx::GoalUUID & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = contexts_.find(id);
  return found == contexts_.end() ? nullptr : found->second;
}

std::shared_ptr<GoalContext> ActiveGoals::remove(const rcl_cxx::GoalUUID & id)
{
  const std::lock_guard lock(mutex_);
  auto node = contexts_.extract(id);
  return node ? std::move(node.mapped()) : nullptr;
}

tl::unexpected<std::string> ActiveGoals::reject(const rcl_cxx::GoalUUID & id, const Error & reason)
{
  discard(id);
  return publish_refusal(id, reason);
}

tl::unexpected<std::string> ActiveGoals::publish_refusal(const rcl_cxx::GoalUUID & id, const Error & reason)
{
  host_.publish_refusal(action_, id, reason);
  return tl::unexpected(with_code(reason.message, reason.code));
}

Status ActiveGoals::start_check(const rcl_cxx::GoalUUID & id, Work work)
{
  const auto context = find(id);
  if (!context) {
    return failure(ErrorCode::exception, "this goal is not registered");
  }
  return start_thread(fmt::format("check of {} {}", action_, id.short_string()), context, std::move(work));
}

Status ActiveGoals::start(const rcl_cxx::GoalUUID & id, Work work)
{
  const auto context = find(id);
  if (!context) {
    return failure(ErrorCode::exception, "this goal was never accepted");
  }
  context->set_started();
  return start_thread(fmt::format("{} {}", action_, id.short_string()), context, std::move(work));
}

Status ActiveGoals::start_thread(std::string name, const std::shared_ptr<GoalContext> & context, Work work)
{
  return host_.goal_threads().start(std::move(name), context->stop_request,
                                    [work = std::move(work), context] { work(context); });
}

void ActiveGoals::stop(const rcl_cxx::GoalUUID & id, const StopReason & reason)
{
  if (const auto context = find(id)) {
    context->stop(reason);
  }
}

void ActiveGoals::discard(const rcl_cxx::GoalUUID & id)
{
  if (const auto context = remove(id)) {
    context->release_lease();
  }
}

void ActiveGoals::finish(const rcl_cxx::GoalUUID & id, const Outcome & outcome)
{
  const auto context = remove(id);
  if (context) {
    context->release_lease();
  }
  const auto & logger = host_.node().get_logger();
  if (outcome) {
    RCL_CXX_INFO(logger, "{}: goal {} succeeded{}{}", action_, id.short_string(),
                 outcome.message().empty() ? "" : ": ", outcome.message());
    return;
  }
  const std::string end = fmt::format("{}: goal {} ended: {}", action_, id.short_string(),
                                      with_code(outcome.message(), outcome.code()));
  if (context && stopped_by_shutdown(outcome, *context->stop_request)) {
    RCL_CXX_INFO(logger, "{}", end);
  } else {
    RCL_CXX_WARN(logger, "{}", end);
  }
}

void ActiveGoals::warn(const rcl_cxx::GoalUUID & id, const std::string & text) const
{
  RCL_CXX_WARN(host_.node().get_logger(), "{}: goal {}: {}", action_, id.short_string(), text);
}

}  // namespace ur_ros_rtde
