#include "ur_ros_rtde/detail/goal_book.hpp"

#include <fmt/format.h>

#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {
/// By nothing else: whatever goes wrong meanwhile adds to the message.
bool ended_by_shutdown(const Outcome & outcome, const Interrupt & interrupt)
{
  const auto why = interrupt.requested();
  return why && why->code == ErrorCode::shutdown && outcome.message() == why->message;
}
}  // namespace

Interruption client_lost()
{
  return Error{
      ErrorCode::client_lost,
      "the client that sent this goal has disappeared: keep its action client until the result has come, or "
      "start command_server with on_client_lost:=continue"};
}

void GoalBook::Ticket::hold(Lease lease)
{
  const std::lock_guard lock(mutex_);
  if (started_ || !interrupt->requested()) {
    lease_ = std::move(lease);
  }
}

bool GoalBook::Ticket::holds() const
{
  const std::lock_guard lock(mutex_);
  return static_cast<bool>(lease_);
}

void GoalBook::Ticket::end(Interruption why)
{
  interrupt->request(std::move(why));
  const std::lock_guard lock(mutex_);
  if (!started_) {
    lease_.release();
  }
}

Outcome missing_result(rcl_cxx::GoalStatus status)
{
  if (status == rcl_cxx::GoalStatus::unknown) {
    return Outcome::failure(ErrorCode::exception,
                            "this driver has no such goal: it has expired, or another driver with the same "
                            "names has accepted it");
  }
  return Outcome::failure(ErrorCode::exception,
                          "the goal ended without a result that can be sent: the driver's log says why");
}

tl::expected<void, std::string> GoalBook::admit(const rcl_cxx::GoalId & id,
                                                const std::function<Status(Ticket &)> & examine)
{
  const auto ticket = std::make_shared<Ticket>();
  Status status = host_.goals().can_start();
  if (status && find(id)) {
    status =
        failure(ErrorCode::invalid_goal,
                fmt::format("a goal with the id {} runs: give each goal an id of its own", id.to_string()));
  }
  if (status) {
    try {
      status = examine(*ticket);
    } catch (const RobotError & error) {
      status = tl::unexpected(error.error());
    } catch (const std::exception & error) {
      status = failure(ErrorCode::exception, fmt::format("looking at the goal failed: {}", error.what()));
    }
  }
  if (!status) {
    host_.publish_refusal(action_, id, status.error());
    return tl::unexpected(fmt::format("{} ({} {})", status.error().message, to_string(status.error().code),
                                      static_cast<int>(status.error().code)));
  }
  const std::lock_guard lock(mutex_);
  tickets_[id] = ticket;
  return {};
}

std::shared_ptr<GoalBook::Ticket> GoalBook::find(const rcl_cxx::GoalId & id) const
{
  const std::lock_guard lock(mutex_);
  const auto found = tickets_.find(id);
  return found == tickets_.end() ? nullptr : found->second;
}

Status GoalBook::start(const rcl_cxx::GoalId & id, std::function<void(std::shared_ptr<Ticket>)> work)
{
  const auto ticket = find(id);
  if (!ticket) {
    return failure(ErrorCode::exception, "this goal was never looked at");
  }
  {
    const std::lock_guard lock(ticket->mutex_);
    ticket->started_ = true;
  }
  return host_.goals().start(fmt::format("{} {}", action_, id.short_string()), ticket->interrupt,
                             [work = std::move(work), ticket] { work(ticket); });
}

void GoalBook::end(const rcl_cxx::GoalId & id, const Interruption & why)
{
  if (const auto ticket = find(id)) {
    ticket->end(why);
  }
}

void GoalBook::discard(const rcl_cxx::GoalId & id)
{
  std::shared_ptr<Ticket> ticket;  // its lease is released after the lock
  const std::lock_guard lock(mutex_);
  if (auto node = tickets_.extract(id)) {
    ticket = std::move(node.mapped());
  }
}

void GoalBook::finish(const rcl_cxx::GoalId & id, const Outcome & outcome)
{
  std::shared_ptr<Ticket> ticket;
  {
    const std::lock_guard lock(mutex_);
    if (auto node = tickets_.extract(id)) {
      ticket = std::move(node.mapped());
    }
  }
  if (ticket) {
    const std::lock_guard lock(ticket->mutex_);
    ticket->lease_.release();
  }
  const auto & logger = host_.node().logger();
  if (outcome) {
    RCL_CXX_INFO(logger, "{}: goal {} succeeded{}{}", action_, id.short_string(),
                 outcome.message().empty() ? "" : ": ", outcome.message());
    return;
  }
  const std::string end =
      fmt::format("{}: goal {} ended: {} ({} {})", action_, id.short_string(), outcome.message(),
                  to_string(outcome.code()), static_cast<int>(outcome.code()));
  if (ticket && ended_by_shutdown(outcome, *ticket->interrupt)) {
    RCL_CXX_INFO(logger, "{}", end);
  } else {
    RCL_CXX_WARN(logger, "{}", end);
  }
}

void GoalBook::warn(const rcl_cxx::GoalId & id, const std::string & text) const
{
  RCL_CXX_WARN(host_.node().logger(), "{}: goal {}: {}", action_, id.short_string(), text);
}

Outcome GoalBook::guarded(const Interrupt & interrupt, const std::function<Outcome()> & body) const
{
  const auto attempt = [&]() -> Outcome {
    try {
      return body();
    } catch (const RobotError & error) {
      return error.error();
    } catch (const std::exception & error) {
      return Outcome::failure(ErrorCode::exception,
                              fmt::format("an exception ended it: {}", printable(error.what())));
    } catch (...) {
      return Outcome::failure(ErrorCode::exception, "an exception of an unknown type ended it");
    }
  };
  Outcome outcome = attempt();
  if (!outcome) {
    if (auto why = interrupt.requested()) {
      return *why;
    }
  }
  return outcome;
}

}  // namespace ur_ros_rtde
