// A goal from its acceptance to its end.
#include "ur_ros_rtde/detail/command_goal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

/// Time for preempted goals to end: longer than a stop that falls back to the dashboard server.
constexpr milliseconds preemption_timeout{6000};
/// For a holder that brakes along its path, and is preempted by a goal that waits no longer than this and a
/// stop.
constexpr milliseconds preempted_braking_timeout{3500};
/// For the commanded deceleration during a shutdown.
constexpr milliseconds shutdown_stop_timeout{1500};
/// For a holder that brakes along its path within its own limits, which may be as gentle as it likes.
constexpr std::chrono::seconds braking_timeout{30};

/// Whether a program may play that is not of this driver. The samples show later what the dashboard server
/// has told; without samples, nothing shows it.
bool foreign_program_may_play(const Robot & robot)
{
  constexpr milliseconds longest_delay{100};
  const auto deadline = std::chrono::steady_clock::now() + longest_delay;
  Sample sample = robot.latest().value_or(Sample{});
  while (std::chrono::steady_clock::now() < deadline) {
    if (!robot.wait_for_next(sample, longest_delay) ||
        (sample.is_program_running() && !robot.ready_to_move())) {
      return true;
    }
  }
  return false;
}

/// The failure may be a consequence of a lost connection or of an ended program.
bool may_be_consequence(ErrorCode code)
{
  return code == ErrorCode::rejected_by_robot || code == ErrorCode::exception;
}

bool is_lost(const Status & status)
{
  return !status && status.error().code == ErrorCode::link_lost;
}

/// For the other goals, if the arm has to be stopped after a successful one.
Error left_moving(const std::string & action)
{
  return {ErrorCode::preempted,
          fmt::format("the arm was stopped at the end of {}, which had left it moving", action)};
}
}  // namespace

Outcome CommandGoal::run_recorded()
{
  const auto execution = command_->executions->begin(*this);
  return run_command(make_context());
}

void CommandGoal::begin_stop()
{
  if (const auto holder = robot().holder(Resource::script)) {
    preempted_goal_ = fmt::format("{}, goal {}", holder->owner, holder->id);
  }
  stopping_ = command_->host.begin_stop(
      stop_options_,
      Error{ErrorCode::preempted, fmt::format("preempted by {}, goal {}", action(), id().short_string())});
}

void CommandGoal::hold(Lease lease)
{
  const std::lock_guard lock(lease_mutex_);
  lease_ = std::move(lease);
}

void CommandGoal::release()
{
  const std::lock_guard lock(lease_mutex_);
  lease_.release();
}

void CommandGoal::on_stop(const Error & why)
{
  const std::lock_guard lock(lease_mutex_);
  StopOptions options = stop_options_;
  milliseconds braking = braking_timeout;
  if (why.code == ErrorCode::preempted) {
    braking = preempted_braking_timeout;
  }
  if (why.code == ErrorCode::shutdown) {
    options.timeout = shutdown_stop_timeout;
    braking = shutdown_stop_timeout;
  }
  robot().request_stop(lease_, options, why, braking);
  if (command_->traits.resource == Resource::mode && leaves_active(why)) {
    robot().begin_stop(options, why);  // a mode cannot be ended while another goal moves the arm
  }
}

bool CommandGoal::started_modes() const
{
  return robot().activities().without(*active_before_).contains_any(outlasting_modes | Activity::call);
}

bool CommandGoal::leaves_active(const Outcome & outcome) const
{
  if (!active_before_) {
    return false;
  }
  const bool keeps_modes = outcome && command_->traits.leaves_mode_active;
  const Activities allowed = *active_before_ | (keeps_modes ? outlasting_modes : Activities());
  // Twice, because a goal may begin or end between two questions.
  for (int i = 0; i < 2; ++i) {
    if (robot().holder(Resource::motion) || robot().is_stopping()) {
      return !outcome && started_modes();  // the arm is in the hands of another goal, or of a stop
    }
    if (robot().activities().without(allowed).empty()) {
      return false;
    }
  }
  return true;
}

/// A script replaces the control program, and is watched by its runner.
std::optional<Error> CommandGoal::ended_by_robot() const
{
  if (command_->traits.allowed_in_any_state && !command_->traits.preempts_all &&
      command_->host.stops() != stops_before_) {
    return stopped_by_the_driver();  // without a lease, nothing else tells it
  }
  if (!command_->needs_motion() || command_->traits.resource == Resource::script) {
    return std::nullopt;
  }
  const std::lock_guard lock(lease_mutex_);
  const Status valid = lease_ ? robot().is_valid(lease_) : Status();
  return valid ? std::nullopt : std::make_optional(valid.error());
}

std::optional<Status> CommandGoal::stopped() const
{
  if (command_->only_stops()) {
    return robot().is_stopping() ? std::nullopt : std::make_optional(Status());
  }
  const std::lock_guard lock(lease_mutex_);
  return robot().stopped(lease_);
}

Status CommandGoal::acquire()
{
  if (lease_ || command_->traits.resource == Resource::none) {
    return {};
  }
  const bool preempts_all = command_->traits.preempts_all;  // a stop, which is executed in every state
  const auto may_go_on = [&] { return preempts_all ? Status() : is_not_overtaken(); };
  // Before it preempts anything. Whether its program continues is known after the stop under way.
  if (!preempts_all && command_->host.stops() != stops_before_) {
    return tl::unexpected(stopped_by_the_driver());
  }
  auto lease = robot().acquire_preempting(claim(), {.timeout = preemption_timeout,
                                                    .since = received_,
                                                    .stop = stop_request().token(),
                                                    .may_go_on = [&] { return may_go_on().has_value(); },
                                                    .for_program = !preempts_all});
  if (Status now = may_go_on(); !now) {
    return now;  // also names the cause if there is no lease
  }
  if (!lease && !preempts_all) {
    return tl::unexpected(lease.error());
  }
  if (lease) {
    hold(std::move(*lease));
  }
  return {};
}

RunContext CommandGoal::make_context()
{
  RunContext context{robot(), shared_stop_request()};
  context.lease = command_->needs_motion() ? &lease_ : nullptr;
  context.command = command_.get();
  context.stopping = stopping_;
  context.preempted_goal = preempted_goal_;
  context.stops_before = stops_before_;
  context.exchange_stop_options = [this](const StopOptions & options) {
    const std::lock_guard lock(lease_mutex_);
    return std::exchange(stop_options_, options);
  };
  context.stop_options = [this] {
    const std::lock_guard lock(lease_mutex_);
    return stop_options_;
  };
  context.log_warning = [this](const std::string & text) { warn(text); };
  context.publish_feedback = [this](const void * feedback) { handle().publish_feedback(feedback); };
  return context;
}

Outcome CommandGoal::execute()
{
  const Generation begin = robot().generation();
  Outcome outcome = guarded(stop_request(), [&]() -> Outcome {
    if (command_->only_stops()) {
      if (program_may_begin_) {
        command_->host.wait_for_startup_requests();
        if (foreign_program_may_play(robot())) {
          begin_stop();  // after the first one
        }
      }
      return run_recorded();
    }
    if (auto why = stop_request().reason()) {
      return *std::move(why);
    }
    if (Status acquired = acquire(); !acquired) {
      return acquired;
    }
    command_->host.forget_owner_of_ended_modes();
    mode_switches_ = command_->host.mode_switches();
    const auto mode_switch =
        command_->traits.leaves_mode_active ? command_->host.begin_mode_switch() : nullptr;
    {
      const std::lock_guard lock(lease_mutex_);
      active_before_ = robot().activities() & outlasting_modes;
    }
    if (auto why = stop_request().reason()) {
      return *std::move(why);
    }
    if (command_->traits.preempts_all) {
      command_->host.wait_for_startup_requests();
    }
    return run_recorded();
  });
  return leave_modes(settle(explain(std::move(outcome), begin)));
}

Outcome CommandGoal::leave_modes(const Outcome & outcome)
{
  const auto outlives = outlives_client();
  if (!outcome || !outlives || !command_->traits.leaves_mode_active || !command_->stops_when_client_lost()) {
    return outcome;
  }
  if (*outlives) {
    command_->host.set_mode_owner(nullptr);
    return outcome;
  }
  shared_handle()->keep_watching_client();
  command_->host.set_mode_owner(shared_handle());
  if (stop_request().reason().value_or(Error{}).code == ErrorCode::client_lost) {
    command_->host.end_modes_of(id());  // it had no owner yet
  }
  return Outcome::success(outcome.message() + "; ends with its client (outlives_client: false)");
}

Outcome CommandGoal::explain(Outcome outcome, const Generation & begin) const
{
  const Resource resource = command_->traits.resource;
  if (outcome && command_->needs_motion() && resource != Resource::script) {
    const std::lock_guard lock(lease_mutex_);
    const Status valid = robot().is_valid(lease_);
    return is_lost(valid) ? valid : outcome;  // the command has not seen what the arm did
  }
  // A script and an error of an extension end the control program, and their reports are precise.
  const bool is_precise = resource == Resource::script ||
                          (command_->is_extension && outcome.code() == ErrorCode::rejected_by_robot);
  if (outcome || is_precise || !may_be_consequence(outcome.code())) {
    return outcome;
  }
  if (resource == Resource::io || command_->traits.allowed_in_any_state) {
    const Status current = robot().is_current(begin);
    const Status valid = is_lost(current) ? current : robot().is_valid(begin);
    return is_lost(valid) ? valid : outcome;
  }
  const std::lock_guard lock(lease_mutex_);
  // What the goal has preempted may have ended the program before the lease.
  const Status valid = lease_ ? robot().is_valid(lease_) : robot().is_valid(begin);
  return valid ? outcome : valid;
}

Outcome CommandGoal::settle(const Outcome & outcome)
{
  if (!moves_arm(command_->traits.resource) || command_->only_stops() || !lease_) {
    return outcome;
  }
  if (is_finished()) {
    return outcome;  // abandoned: it was stopped, and its calls have been rejected since
  }
  const bool shares_arm = command_->traits.resource == Resource::mode;
  if (shares_arm && !stop_request().reason() && !leaves_active(outcome)) {
    return outcome;
  }
  StopOptions options = stop_options_;
  if (outcome) {
    const bool leaves_modes =
        command_->traits.leaves_mode_active || command_->host.mode_switches() != mode_switches_;
    options.keep = active_before_.value_or(Activities()) | (leaves_modes ? outlasting_modes : Activities());
    if (!stop_request().reason() && robot().is_at_rest_except(options.keep)) {
      return outcome;
    }
  }
  if (stop_request().reason().value_or(Error{}).code == ErrorCode::shutdown) {
    options.timeout = shutdown_stop_timeout;
  }
  const auto stopped = shares_arm
                           ? robot().stop_motion(options, outcome ? left_moving(action()) : outcome.error())
                           : robot().end_motion(lease_, options);
  const auto why = stop_request().reason();
  // A mode that was to outlast its goal has been ended.
  const Outcome end = outcome && why && command_->traits.leaves_mode_active ? Outcome(*why) : outcome;
  if (stopped) {
    return end;
  }
  return end ? standstill_not_confirmed(stopped.error())
             : standstill_not_confirmed(end.error(), stopped.error());
}

}  // namespace ur_ros_rtde
