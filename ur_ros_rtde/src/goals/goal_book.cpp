#include "ur_ros_rtde/goal_book.hpp"

#include <fmt/format.h>

#include "robot/text.hpp"

namespace ur_ros_rtde {

tl::expected<void, std::string> GoalBook::admit(const rcl_cxx::GoalId & id,
                                                const std::function<Status(Ticket &)> & examine)
{
  forget_unaccepted();
  auto ticket = std::make_shared<Ticket>();
  Status status = host_.goals().can_start();
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
  tickets_[id] = std::move(ticket);
  return {};
}

void GoalBook::forget_unaccepted()
{
  // A goal that was admitted but then not accepted (its answer could not be sent) would hold the robot.
  const std::lock_guard lock(mutex_);
  std::erase_if(tickets_, [](const auto & entry) { return !entry.second->started; });
}

Status GoalBook::start(const rcl_cxx::GoalId & id, std::function<void(std::shared_ptr<Ticket>)> work)
{
  std::shared_ptr<Ticket> ticket;
  {
    const std::lock_guard lock(mutex_);
    const auto found = tickets_.find(id);
    if (found == tickets_.end()) {
      return failure(ErrorCode::exception, "this goal was never looked at");
    }
    ticket = found->second;
    ticket->started = true;
  }
  return host_.goals().start(fmt::format("{} {}", action_, id.short_string()), ticket->interrupt,
                             [work = std::move(work), ticket] { work(ticket); });
}

void GoalBook::cancel(const rcl_cxx::GoalId & id)
{
  std::shared_ptr<Ticket> ticket;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = tickets_.find(id); found != tickets_.end()) {
      ticket = found->second;
    }
  }
  if (ticket) {
    ticket->interrupt->request(Error{ErrorCode::canceled, "canceled by a client"});
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
    ticket->lease.release();
  }
  const auto & logger = host_.node().logger();
  if (outcome) {
    RCL_CXX_INFO(logger, "{}: goal {} succeeded{}{}", action_, id.short_string(),
                 outcome.message().empty() ? "" : ": ", outcome.message());
  } else {
    RCL_CXX_WARN(logger, "{}: goal {} ended: {} ({} {})", action_, id.short_string(), outcome.message(),
                 to_string(outcome.code()), static_cast<int>(outcome.code()));
  }
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
