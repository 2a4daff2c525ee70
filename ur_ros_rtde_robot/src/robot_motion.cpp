// Who may move the arm, what moves it, and how it is stopped.
#include <fmt/format.h>

#include <utility>

#include "motion/motion_blocker.hpp"
#include "robot_impl.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

Error stopped_by_the_driver()
{
  return {ErrorCode::preempted, "the arm was stopped"};
}

Expected<Lease> Robot::acquire(Claim claim)
{
  const Claim asked = claim;
  return impl_->arbiter.acquire(std::move(claim), [&] { return impl_->admit(asked); });
}

Expected<Lease> Robot::acquire_preempting(const Claim & claim, const Waiting & waiting)
{
  const auto deadline = Permit::Clock::now() + waiting.timeout;
  const Generation begin = waiting.since.value_or(generation());
  bool was_stopping = false;
  bool had_yielded = false;  // the control program, to a script
  bool was_ready = false;    // otherwise, something else is in the way
  const auto admit = [&] {
    was_stopping = impl_->stopper.is_stopping();
    had_yielded = impl_->manager.control_owner() == ControlOwner::script;
    was_ready = impl_->ready_to_move().has_value();
    return impl_->admit(claim);
  };
  const auto wait = [&] {
    if (was_stopping) {
      return impl_->stopper.wait_until_idle(deadline, waiting.stop);
    }
    const bool returns = had_yielded || generation().ended_by_driver != begin.ended_by_driver;
    return waiting.for_program && returns && (had_yielded || !was_ready) && is_continued(begin) &&
           impl_->wait_for_control_program(deadline);
  };
  // Otherwise, the next attempt would preempt a holder that has come after the caller.
  const auto retry = [&] { return wait() && (!waiting.may_go_on || waiting.may_go_on()); };
  return impl_->arbiter.acquire_preempting(claim, admit, retry, deadline, waiting.stop);
}

Status Robot::may_use(const Claim & claim) const
{
  if (Status usable = impl_->may_use(claim); !usable) {
    return usable;
  }
  const bool preempts_mode = claim.resource == Resource::script && holder(Resource::mode);
  return preempts_mode ? Status() : impl_->leaves_force_mode_alone(claim);
}

std::optional<Claim> Robot::holder(Resource resource) const
{
  const auto permit = impl_->arbiter.holder(resource);
  return permit ? std::optional(permit->claim()) : std::nullopt;
}

Generation Robot::generation() const
{
  return impl_->generation();
}

Status Robot::is_current(const Generation & generation) const
{
  const Generation now = impl_->generation();
  if (now == generation) {
    return {};
  }
  if (now.link != generation.link) {
    return failure(ErrorCode::link_lost, connection_replaced);
  }
  if (now.ends != generation.ends) {
    return tl::unexpected(impl_->program_ended_error());
  }
  if (now.robot_stops != generation.robot_stops) {
    return tl::unexpected(impl_->tracker.stop_cause());
  }
  return failure(ErrorCode::program_stopped,
                 "the control program was replaced or started again; the motion is not resumed");
}

Status Robot::is_continued(const Generation & generation) const
{
  const Generation now = impl_->generation();
  if (now.link == generation.link && now.robot_stops != generation.robot_stops) {
    return tl::unexpected(impl_->tracker.stop_cause());  // although the driver has ended the program
  }
  const std::uint32_t by_driver = now.ended_by_driver - generation.ended_by_driver;
  const std::uint32_t restarts = now.restarted_by_driver - generation.restarted_by_driver;
  const bool continued = now.link == generation.link && now.failed_starts == generation.failed_starts &&
                         now.replacements == generation.replacements &&
                         now.ends - generation.ends == by_driver &&
                         (by_driver > 0 || now.starts - generation.starts <= restarts);
  return continued ? Status() : is_current(generation);
}

Status Robot::may_continue(const Lease & lease) const
{
  if (!lease) {
    return failure(ErrorCode::exception, "there is no lease");
  }
  if (auto why = lease.permit_->revoked()) {
    return tl::unexpected(*std::move(why));
  }
  return is_valid(lease);
}

Status Robot::is_valid(const Lease & lease) const
{
  return is_valid(lease.permit_->generation());
}

Status Robot::is_valid(const Generation & generation) const
{
  const Status possible = motion_possible();
  const Status current = is_current(generation);
  if (possible) {
    return current;
  }
  // It names the cause better than the change of the generation that follows from it, but for two that follow
  // themselves: a program ends because its connection was lost, even if the new one has shown it running for
  // some cycles, and the connection is replaced because the program has ended.
  const ErrorCode code = possible.error().code;
  const bool follows =
      !current && ((code == ErrorCode::link_lost && impl_->generation().ends != generation.ends) ||
                   (code == ErrorCode::program_stopped && current.error().code == ErrorCode::link_lost));
  return follows ? current : possible;
}

std::function<Expected<std::shared_ptr<void>>()> Robot::permission(const Lease & lease) const
{
  return [this, permit = lease.permit_]() -> Expected<std::shared_ptr<void>> {
    if (!permit) {
      return failure(ErrorCode::exception, "there is no lease");
    }
    if (!moves_arm(permit->claim().resource)) {
      return failure(ErrorCode::exception, fmt::format("a lease of the resource `{}` does not move the arm",
                                                       to_string(permit->claim().resource)));
    }
    if (auto why = permit->revoked()) {
      return tl::unexpected(*std::move(why));  // without becoming an activity
    }
    auto call = impl_->activities.begin_call(permit);
    if (auto why = permit->revoked()) {
      return tl::unexpected(*std::move(why));
    }
    if (const Status current = is_current(permit->generation()); !current) {
      return tl::unexpected(current.error());
    }
    return call;
  };
}

Status Robot::motion_possible() const
{
  return impl_->motion_possible();
}

MotionMark Robot::mark_motion() const
{
  const auto view = impl_->tracker.view();
  return {view.async, view.program, impl_->activities.sent_moves()};
}

bool Robot::has_sent_move(const MotionMark & since) const
{
  return impl_->activities.sent_moves() != since.moves;
}

MotionProgress Robot::motion_progress(const MotionMark & mark) const
{
  const auto view = impl_->tracker.view();
  MotionProgress result;
  result.started = !(view.async == mark.async);
  result.running = view.async.running();
  result.at_rest = view.at_rest;
  result.program_ended = view.program != mark.program;
  result.progress = view.async.running() ? view.async.progress() : 0;
  return result;
}

bool Robot::is_moving() const
{
  const auto view = impl_->tracker.view();
  return !view.at_rest || view.operating();
}

Activities Robot::activities() const
{
  return impl_->activities.now();
}

bool Robot::is_at_rest_except(Activities modes) const
{
  const Activities active = activities();
  return active.without(modes).empty() && (active.contains_any(modes) || !is_moving());
}

Expected<StopReport> Robot::stop_motion(const StopOptions & options, const Error & why)
{
  return begin_stop(options, why).get();
}

std::shared_ptr<void> Robot::hold_program()
{
  return impl_->manager.hold();
}

std::shared_future<Expected<StopReport>> Robot::begin_stop(const StopOptions & options, const Error & why)
{
  return impl_->stopper.begin(options, why);
}

void Robot::request_stop(const Lease & lease, const StopOptions & options, const Error & why,
                         std::chrono::milliseconds braking_timeout)
{
  if (lease && moves_arm(lease.permit_->claim().resource)) {
    impl_->stopper.request(lease.permit_, options, why, braking_timeout);
  }
}

Expected<StopReport> Robot::end_motion(const Lease & lease, const StopOptions & options)
{
  if (!lease || !moves_arm(lease.permit_->claim().resource)) {
    return StopReport{};
  }
  return impl_->stopper.end(*lease.permit_, options).get();
}

Expected<StopReport> Robot::pause_motion(const Lease & lease, const StopOptions & options)
{
  if (!lease || !moves_arm(lease.permit_->claim().resource)) {
    return StopReport{};
  }
  return impl_->stopper.pause(*lease.permit_, options).get();
}

bool Robot::is_stopping() const
{
  return impl_->stopper.is_stopping();
}

bool Robot::wait_for_stopped_holders(std::chrono::milliseconds timeout) const
{
  return impl_->arbiter.wait_for_revoked_holders(timeout);
}

std::optional<Status> Robot::stopped(const Lease & lease) const
{
  if (!lease || !moves_arm(lease.permit_->claim().resource)) {
    return Status();
  }
  return impl_->stopper.outcome(*lease.permit_);
}

Robot::Braking::Braking(const Lease & lease) : permit_(lease.permit_)
{
  permit_->set_brakes_itself(true);
}

Robot::Braking::~Braking()
{
  permit_->set_brakes_itself(false);
}

void Robot::Braking::sent() const
{
  permit_->set_braking();
}

}  // namespace ur_ros_rtde
