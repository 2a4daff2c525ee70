#include "ur_ros_rtde/detail/command_goals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ur_ros_rtde {
namespace {
/// For whoever gives way: longer than a stop that needs its last means.
constexpr std::chrono::milliseconds takeover_limit{6000};
/// A shutdown has less patience with a stop that does not work than a goal has.
constexpr std::chrono::milliseconds shutdown_stop_limit{1500};
/// Before a goal is accepted.
constexpr std::chrono::milliseconds dashboard_answer_limit{500};

bool gives_way(ErrorCode code)
{
  return code == ErrorCode::preempted;
}
}  // namespace

/// Gets ready when the first check asks the robot something.
class CommandGoals::RobotPreflight : public Preflight {
 public:
  RobotPreflight(CommandGoals & goals, const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket)
      : goals_(goals), id_(id), ticket_(ticket)
  {
  }

  Status prepare() override
  {
    if (Status ready = goals_.readiness(); !ready) {
      return ready;
    }
    if (ticket_.holds() || goals_.traits_.resource == Resource::none || goals_.preempts()) {
      return {};
    }
    auto lease = robot().arbiter().acquire(goals_.claim(id_, ticket_));
    if (!lease) {
      return tl::unexpected(lease.error());
    }
    ticket_.hold(std::move(*lease));
    return {};
  }
  ArmLimits limits() const override { return goals_.host_.limits(); }
  Robot & robot() override { return goals_.host_.robot(); }

 private:
  CommandGoals & goals_;
  const rcl_cxx::GoalId & id_;
  GoalBook::Ticket & ticket_;
};

CommandGoals::CommandGoals(CommandHost & host, std::string action, CommandTraits traits)
    : host_(host), traits_(std::move(traits)), book_(host, std::move(action))
{
}

Claim CommandGoals::claim(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket) const
{
  return {traits_.resource, book_.action(), id.short_string(),
          [weak = ticket.weak_from_this()](const std::string & by) {
            if (const auto holder = weak.lock()) {
              holder->end(Error{ErrorCode::preempted, fmt::format("{} took over", by)});
            }
          }};
}

bool CommandGoals::preempts() const
{
  if (traits_.takes_over || host_.options().preempt_when_busy) {
    return true;
  }
  const auto holder = host_.robot().arbiter().holder(traits_.resource);
  return traits_.replaces_its_own && holder && holder->owner == book_.action();
}

Status CommandGoals::readiness() const
{
  Robot & robot = host_.robot();
  if (traits_.any_state) {
    const auto mode = robot.ask_dashboard("robotmode", dashboard_answer_limit);
    return mode ? Status() : tl::unexpected(mode.error());
  }
  if (!traits_.extension.empty()) {
    if (Status has = robot.has_extension(traits_.extension); !has) {
      return has;
    }
  }
  if (moves() && !traits_.takes_over) {
    if (const Status ready = robot.ready_to_move(); !ready || traits_.switches_mode || !robot.guided()) {
      return ready;
    }
    return failure(
        ErrorCode::busy,
        "somebody may be moving the arm by hand: end that first (freedrive_stop, end_teach_mode, stop)");
  }
  const RobotStatus status = host_.robot().status();
  if (status.state == RobotState::disconnected || status.state == RobotState::connecting) {
    return failure(status.cause == ErrorCode::none ? ErrorCode::not_ready : status.cause, status.message);
  }
  return {};
}

tl::expected<void, std::string> CommandGoals::admit(const rcl_cxx::GoalId & id,
                                                    const std::function<void(Check &)> & check)
{
  return book_.admit(id, [&](GoalBook::Ticket & ticket) -> Status {
    RobotPreflight preflight(*this, id, ticket);
    Check result(&preflight);
    check(result);
    result.ready();
    return result.ok() ? Status() : tl::unexpected(*result.error());
  });
}

Status CommandGoals::take(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket, const StopOptions & stop)
{
  if (auto why = ticket.interrupt->requested()) {
    return tl::unexpected(*why);
  }
  if (ticket.holds() || traits_.resource == Resource::none) {
    return {};
  }
  if (traits_.takes_over) {
    host_.set_takeover_stop(stop);
    if (const auto holder = host_.robot().arbiter().holder(traits_.resource)) {
      ticket.displaced = fmt::format("{}, goal {}", holder->owner, holder->id);
    }
  }
  auto lease = host_.robot().arbiter().acquire_preempting(claim(id, ticket), takeover_limit);
  if (traits_.takes_over) {
    host_.set_takeover_stop(std::nullopt);
  }
  if (lease) {
    ticket.hold(std::move(*lease));
  } else if (!traits_.takes_over) {  // who does not give way must not keep the arm from being stopped
    return tl::unexpected(lease.error());
  }
  return {};
}

Outcome CommandGoals::carry_out(const rcl_cxx::GoalId & id, GoalBook::Ticket & ticket,
                                const std::function<StopOptions()> & stop_options,
                                const std::function<Outcome()> & body)
{
  StopOptions stop;
  const auto whole = [&]() -> Outcome {
    stop = stop_options();
    if (Status taken = take(id, ticket, stop); !taken) {
      return taken;
    }
    if (auto why = ticket.interrupt->requested()) {
      return *why;
    }
    return body();
  };
  Outcome outcome = book_.guarded(*ticket.interrupt, whole);
  if (!moves() || !ticket.holds()) {
    return outcome;
  }
  return book_.guarded(Interrupt(), [&] { return settle(outcome, ticket, stop); });
}

Outcome CommandGoals::settle(Outcome outcome, const GoalBook::Ticket &, StopOptions stop)
{
  if (outcome && (traits_.switches_mode || !host_.robot().moving())) {
    return outcome;
  }
  if (gives_way(outcome.code())) {
    stop = host_.takeover_stop().value_or(stop);
  } else if (outcome.code() == ErrorCode::shutdown) {
    stop.limit = std::min(stop.limit, shutdown_stop_limit);
  }
  const auto stopped = host_.robot().stop_motion(stop);
  if (stopped) {
    return outcome;
  }
  const std::string warning =
      fmt::format("whether the arm stands still is not known: {}", stopped.error().message);
  if (outcome) {
    return Outcome::failure(stopped.error().code, warning);
  }
  return Outcome::failure(outcome.code(), fmt::format("{}; {}", outcome.message(), warning));
}

}  // namespace ur_ros_rtde
