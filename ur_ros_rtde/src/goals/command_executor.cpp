#include "ur_ros_rtde/detail/command_executor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {
namespace {
/// Time for a preempted goal to end: longer than a stop that falls back to the dashboard server.
constexpr std::chrono::milliseconds preemption_timeout{6000};
/// Time limit of a stop during a shutdown.
constexpr std::chrono::milliseconds shutdown_stop_timeout{1500};
/// For the dashboard server's answer before a goal is accepted.
constexpr std::chrono::milliseconds dashboard_timeout{500};

/// Succeeds if the dashboard server answers.
Status query_dashboard(Robot & robot)
{
  const auto mode = robot.query_dashboard("robotmode", dashboard_timeout);
  return mode ? Status() : tl::unexpected(mode.error());
}
}  // namespace

/// Checks the state and acquires the resource when the first check needs the robot.
class CommandExecutor::RobotPreflight : public Preflight {
 public:
  RobotPreflight(CommandExecutor & executor, const rcl_cxx::GoalUUID & id, GoalContext & context)
      : executor_(executor), id_(id), context_(context)
  {
  }

  Status prepare() override
  {
    if (Status possible = executor_.check_state(); !possible) {
      return possible;
    }
    if (context_.holds_lease() || executor_.traits_.resource == Resource::none || executor_.preempts()) {
      return {};
    }
    auto lease = robot().arbiter().acquire(executor_.claim(id_, context_));
    if (!lease) {
      return tl::unexpected(lease.error());
    }
    context_.hold(std::move(*lease));
    return {};
  }
  ArmLimits limits() const override { return executor_.host_.limits(); }
  Robot & robot() override { return executor_.host_.robot(); }

 private:
  CommandExecutor & executor_;
  const rcl_cxx::GoalUUID & id_;
  GoalContext & context_;
};

CommandExecutor::CommandExecutor(CommandHost & host, std::string action, const CommandTraits & traits,
                                 std::string extension)
    : host_(host), traits_(traits), extension_(std::move(extension)), goals_(host, std::move(action))
{
}

Claim CommandExecutor::claim(const rcl_cxx::GoalUUID & id, GoalContext & context) const
{
  return {traits_.resource, goals_.action(), id.short_string(),
          [weak = context.weak_from_this()](const std::string & by) {
            if (const auto holder = weak.lock()) {
              holder->stop(Error{ErrorCode::preempted, fmt::format("preempted by {}", by)});
            }
          }};
}

bool CommandExecutor::preempts() const
{
  if (traits_.preempts_all || host_.options().preempt_when_busy) {
    return true;
  }
  const auto holder = host_.robot().arbiter().holder(traits_.resource);
  return traits_.preempts_self && holder && holder->owner == goals_.action();
}

Status CommandExecutor::check_state() const
{
  Robot & robot = host_.robot();
  if (traits_.allowed_in_any_state) {
    return {};  // query_dashboard() follows
  }
  if (!extension_.empty()) {
    if (Status available = robot.has_extension(extension_); !available) {
      return available;
    }
  }
  if (moves_arm() && !traits_.preempts_all) {
    if (const Status ready = robot.ready_to_move();
        !ready || traits_.leaves_mode_active || !robot.in_freedrive()) {
      return ready;
    }
    return failure(ErrorCode::busy,
                   "the arm is in freedrive or teach mode and may be moved by hand: end the mode first "
                   "(freedrive_stop, end_teach_mode, stop)");
  }
  const RobotStatus status = robot.status();
  if (status.state == RobotState::disconnected || status.state == RobotState::connecting) {
    return failure(status.cause == ErrorCode::none ? ErrorCode::not_ready : status.cause, status.message);
  }
  return {};
}

rcl_cxx::GoalDecision CommandExecutor::accept(const rcl_cxx::GoalUUID & id,
                                              const std::function<void(Check &)> & check)
{
  std::vector<RobotQuery> queries;
  const auto accepted = goals_.accept(id, [&](GoalContext & context) -> Status {
    RobotPreflight preflight(*this, id, context);
    Check result(&preflight);
    check(result);
    result.ready();
    if (traits_.allowed_in_any_state) {
      result.query(query_dashboard);
    }
    queries = result.take_queries();
    return result.ok() ? Status() : tl::unexpected(*result.error());
  });
  if (!accepted || queries.empty()) {
    return accepted;
  }
  return rcl_cxx::DeferredGoalResponse{
      [this, id, pending = std::move(queries)](rcl_cxx::SendGoalResponse respond) {
        start_queries(id, pending, std::move(respond));
      }};
}

void CommandExecutor::start_queries(const rcl_cxx::GoalUUID & id, std::vector<RobotQuery> queries,
                                    rcl_cxx::SendGoalResponse respond)
{
  const Status started = goals_.start_check(
      id, [this, id, pending = std::move(queries), respond](const std::shared_ptr<GoalContext> & context) {
        const Outcome outcome =
            guarded(*context->stop_request, [&] { return run_queries(pending, *context->stop_request); });
        respond(outcome ? rcl_cxx::GoalResponse() : goals_.reject(id, outcome.error()));
      });
  if (!started) {
    respond(goals_.reject(id, started.error()));
  }
}

Outcome CommandExecutor::run_queries(const std::vector<RobotQuery> & queries,
                                     const StopRequest & stop_request) const
{
  for (const RobotQuery & query : queries) {
    if (auto reason = stop_request.reason()) {
      return *std::move(reason);
    }
    if (Status answer = query(host_.robot()); !answer) {
      return answer;
    }
  }
  return Outcome::success();
}

Status CommandExecutor::acquire(const rcl_cxx::GoalUUID & id, GoalContext & context, const StopOptions & stop)
{
  if (auto reason = context.stop_request->reason()) {
    return tl::unexpected(*std::move(reason));
  }
  if (context.holds_lease() || traits_.resource == Resource::none) {
    return {};
  }
  Arbiter & arbiter = host_.robot().arbiter();
  if (traits_.preempts_all) {
    host_.set_preemption_stop(stop);
    if (const auto holder = arbiter.holder(traits_.resource)) {
      context.preempted_goal = fmt::format("{}, goal {}", holder->owner, holder->id);
    }
  }
  auto lease = arbiter.acquire_preempting(claim(id, context), preemption_timeout);
  if (traits_.preempts_all) {
    host_.set_preemption_stop(std::nullopt);
  }
  if (lease) {
    context.hold(std::move(*lease));
  } else if (!traits_.preempts_all) {  // a stop is executed even if the holder keeps the resource
    return tl::unexpected(lease.error());
  }
  return {};
}

Outcome CommandExecutor::execute(const rcl_cxx::GoalUUID & id, GoalContext & context,
                                 const std::function<StopOptions()> & stop_options,
                                 const std::function<Outcome()> & body)
{
  StopOptions stop;
  const Outcome outcome = guarded(*context.stop_request, [&]() -> Outcome {
    stop = stop_options();
    if (Status acquired = acquire(id, context, stop); !acquired) {
      return acquired;
    }
    if (auto reason = context.stop_request->reason()) {
      return *std::move(reason);
    }
    return body();
  });
  if (!moves_arm() || !context.holds_lease()) {
    return outcome;
  }
  return guarded([&] { return bring_to_standstill(outcome, stop); });
}

Outcome CommandExecutor::bring_to_standstill(const Outcome & outcome, StopOptions stop)
{
  if (outcome && (traits_.leaves_mode_active || !host_.robot().moving())) {
    return outcome;
  }
  if (outcome.code() == ErrorCode::preempted) {
    stop = host_.preemption_stop().value_or(stop);
  } else if (outcome.code() == ErrorCode::shutdown) {
    stop.limit = std::min(stop.limit, shutdown_stop_timeout);
  }
  const auto stopped = host_.robot().stop_motion(stop);
  if (stopped) {
    return outcome;
  }
  const std::string warning = fmt::format("standstill is not confirmed: {}", stopped.error().message);
  if (outcome) {
    return Outcome::failure(stopped.error().code, warning);
  }
  return Outcome::failure(outcome.code(), fmt::format("{}; {}", outcome.message(), warning));
}

}  // namespace ur_ros_rtde
