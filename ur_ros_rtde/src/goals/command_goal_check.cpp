// A goal before its acceptance: whether it may be executed.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ur_ros_rtde/detail/command_goal.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {

/// For the dashboard server's answer before a goal is accepted.
constexpr std::chrono::milliseconds dashboard_timeout{500};

/// Succeeds if the dashboard server answers.
Status query_dashboard(const Robot & robot)
{
  const auto mode = robot.query_dashboard("robotmode", dashboard_timeout);
  return mode ? Status() : tl::unexpected(mode.error());
}

}  // namespace

Status Executions::are_current(const std::string & action) const
{
  const std::lock_guard lock(mutex_);
  const bool has_abandoned =
      std::ranges::any_of(goals_, [](const Goal * goal) { return goal->is_finished(); });
  return !has_abandoned
             ? Status()
             : failure(
                   ErrorCode::busy,
                   fmt::format("an earlier goal of {} has been abandoned, and its command has not returned: "
                               "try again when it has, or restart the driver",
                               action));
}

Claim CommandGoal::claim()
{
  Claim result;
  result.resource = command_->traits.resource;
  result.owner = action();
  result.id = id().short_string();
  result.switches_hand_guiding = command_->traits.switches_hand_guiding;
  result.excludes_force_mode = command_->traits.excludes_force_mode;
  result.blocks_queries = command_->traits.blocks_queries;
  result.preempts_only_own = !command_->traits.preempts_all && !command_->host.options().preempt_when_busy;
  result.preempt = [weak = weak_from_this()](const Error & why) {
    if (const auto goal = weak.lock()) {
      goal->stop(why);
    }
  };
  return result;
}

bool CommandGoal::preempts() const
{
  if (command_->traits.preempts_all || command_->host.options().preempt_when_busy) {
    return true;
  }
  const auto holder = robot().holder(command_->traits.resource);
  return command_->traits.preempts_self && holder && holder->owner == action();
}

/// Takes the robot, unless other goals have to be preempted first, which takes time.
Status CommandGoal::prepare()
{
  if (command_->traits.allowed_in_any_state || command_->is_stop()) {
    return {};
  }
  if (command_->is_extension) {
    if (Status available = robot().has_extension(command_->plugin); !available) {
      return available;
    }
  }
  if (Status may = may_execute(); !may) {
    return may;
  }
  const Claim wanted = claim();
  if (wanted.resource == Resource::none || preempts()) {
    return robot().may_use(wanted);
  }
  const std::lock_guard lock(lease_mutex_);
  if (lease_) {
    return {};
  }
  auto lease = robot().acquire(wanted);
  if (!lease) {
    return tl::unexpected(lease.error());
  }
  if (Status not_overtaken = is_not_overtaken(); !not_overtaken) {
    return not_overtaken;
  }
  lease_ = std::move(*lease);
  return {};
}

Status CommandGoal::may_execute() const
{
  if (command_->needs_motion()) {
    if (Status free = command_->host.may_move(); !free) {
      return free;
    }
  }
  return command_->traits.resource == Resource::none || command_->is_stop()
             ? Status()
             : command_->executions->are_current(action());
}

Status CommandGoal::is_not_overtaken() const
{
  if (!moves_arm(command_->traits.resource)) {
    return {};
  }
  if (command_->host.stops() != stops_before_) {
    return tl::unexpected(stopped_by_the_driver());
  }
  if (Status may = may_execute(); !may) {
    return may;  // since the check
  }
  return robot().is_continued(received_);
}

Status CommandGoal::check(std::vector<GoalQuery> & queries)
{
  stops_before_ = command_->host.stops();
  received_ = robot().generation();
  Frames & frames = command_->host.frames();
  if (!has_frame(frames.base())) {
    return check_in_base(queries);
  }
  const auto holder = [this] {
    const auto claim = robot().holder(command_->traits.resource);
    return claim ? claim->id : std::string();
  };
  queries.push_back([this, &frames, holder, before = holder()]() -> Status {
    if (Status resolved = resolve(frames, stop_request().token()); !resolved) {
      return resolved;
    }
    if (const std::string now = holder(); !now.empty() && now != before && preempts()) {
      return failure(ErrorCode::preempted, fmt::format("goal {}, which came later, has preempted it", now));
    }
    std::vector<GoalQuery> next;
    Status status = check_in_base(next);
    for (auto query = next.begin(); status && query != next.end(); ++query) {
      status = (*query)();
    }
    return status;
  });
  return {};
}

Status CommandGoal::check_in_base(std::vector<GoalQuery> & queries)
{
  Check result(&robot(), [this] { return prepare(); });
  check_fields(result);
  result.ready();
  if (command_->traits.allowed_in_any_state) {
    result.query(query_dashboard);
  }
  if (!result.ok()) {
    release();
    return tl::unexpected(*result.error());
  }
  stop_options_ = stop_options();
  stop_options_.ends_foreign_program = command_->traits.preempts_all;
  for (RobotQuery & query : result.take_queries()) {
    queries.push_back([this, ask = std::move(query)] { return ask(robot()); });
  }
  if (command_->traits.preempts_all) {
    begin_stop();  // now: the acceptance may have to wait for the discovery of the client
    program_may_begin_ = command_->host.has_startup_requests();
  }
  return {};
}

}  // namespace ur_ros_rtde
