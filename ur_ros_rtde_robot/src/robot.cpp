#include "ur_ros_rtde_robot/robot.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "motion/motion_blocker.hpp"
#include "robot_impl.hpp"

namespace ur_ros_rtde {

Error stopped_by_the_driver()
{
  return {ErrorCode::preempted, "the arm was stopped"};
}

Robot::Robot(RobotOptions options, LogFunction log) : impl_(std::make_unique<Impl>(std::move(options), log))
{
}

Robot::~Robot() = default;

void Robot::on_status(std::function<void(const RobotStatus &)> function)
{
  impl_->manager.status_function = std::move(function);
}

void Robot::on_sample(std::function<void(const Sample &)> function)
{
  impl_->sample_function = std::move(function);
}

void Robot::connect()
{
  impl_->state.start();
  impl_->dashboard.start();
  impl_->manager.start();
}

void Robot::start()
{
  connect();
  if (impl_->options.control_mode == ControlMode::control_urcap) {
    impl_->server.start();
  }
  impl_->manager.claim();
}

RobotStatus Robot::status() const
{
  return impl_->manager.status();
}

Status Robot::ready_to_move() const
{
  return impl_->ready_to_move();
}

Status Robot::wait_until_ready(std::chrono::milliseconds timeout, std::stop_token stop) const
{
  return impl_->manager.wait_until_ready(timeout, std::move(stop));
}

std::optional<ControllerVersion> Robot::version() const
{
  return impl_->state.version();
}

std::string Robot::model() const
{
  return impl_->model.name();
}

std::optional<kinematics::DhRows> Robot::calibration() const
{
  return impl_->model.calibration();
}

double Robot::cycle_time() const
{
  return 1.0 / version().value_or(ControllerVersion{.major = 5}).frequency();
}

ArmLimits Robot::limits() const
{
  return impl_->model.limits();
}

const std::string & Robot::address() const
{
  return impl_->options.address;
}

int Robot::realtime_priority() const
{
  return impl_->options.realtime_priority;
}

Expected<Lease> Robot::acquire(Claim claim)
{
  const Claim asked = claim;
  return impl_->arbiter.acquire(std::move(claim), [&] { return impl_->admit(asked); });
}

Expected<Lease> Robot::acquire_preempting(Claim claim, std::chrono::milliseconds timeout,
                                          const std::stop_token & stop)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  const auto left = [&] {
    return std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  };
  while (true) {
    auto lease = impl_->arbiter.acquire_preempting(claim, [&] { return impl_->admit(claim); }, left(), stop);
    if (lease || !impl_->stopper.wait_until_idle(deadline, stop) || left().count() <= 0) {
      return lease;
    }
  }
}

Status Robot::may_use(const Claim & claim) const
{
  return impl_->may_use(claim);
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
  return failure(ErrorCode::program_stopped,
                 "the control program was replaced or started again; the motion is not resumed");
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
  if (Status possible = motion_possible(); !possible) {
    return possible;  // names the cause better than the change of the generation that follows from it
  }
  return is_current(lease.permit_->generation());
}

std::function<Status()> Robot::permission(const Lease & lease) const
{
  return [this, permit = lease.permit_]() -> Status {
    if (!permit) {
      return failure(ErrorCode::exception, "there is no lease");
    }
    if (auto why = permit->revoked()) {
      return tl::unexpected(*std::move(why));
    }
    return is_current(permit->generation());
  };
}

Locked<ur_rtde::RTDEControlInterface> Robot::control(const Lease & lease)
{
  return control().permitted_by(permission(lease));
}

Locked<ur_rtde::RTDEControlInterface> Robot::control()
{
  if (auto control = impl_->interfaces.control()) {
    return *control;
  }
  throw RobotError(impl_->unavailable_error());
}

Locked<ur_rtde::RTDEReceiveInterface> Robot::receive() const
{
  return impl_->state.receive();
}

Locked<ur_rtde::RTDEIOInterface> Robot::io() const
{
  if (auto io = impl_->interfaces.io()) {
    return *io;
  }
  throw RobotError(impl_->unavailable_error());
}

Locked<ur_rtde::DashboardClient> Robot::dashboard() const
{
  return impl_->dashboard.dashboard();
}

Expected<std::string> Robot::query_dashboard(const std::string & line, std::chrono::milliseconds timeout,
                                             const std::stop_token & stop) const
{
  return impl_->dashboard.request(line, timeout, stop);
}

std::optional<Sample> Robot::latest() const
{
  return impl_->state.latest();
}

bool Robot::wait_for_next(Sample & last, std::chrono::milliseconds timeout, std::stop_token stop) const
{
  if (!impl_->state.wait_for_next(last, timeout, std::move(stop))) {
    return false;
  }
  // The receiving thread may not have done so yet, and the caller asks for motion_progress() next.
  impl_->tracker.add(last);
  return true;
}

Status Robot::motion_possible() const
{
  return impl_->motion_possible();
}

MotionMark Robot::mark_motion() const
{
  const auto view = impl_->tracker.view();
  return {view.async, view.program};
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

Status Robot::set_watchdog(double frequency)
{
  return impl_->set_watchdog(frequency);
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

bool Robot::is_stopped(const Lease & lease) const
{
  if (!lease || !moves_arm(lease.permit_->claim().resource)) {
    return true;
  }
  return lease.permit_->revoked() && !is_stopping();
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

ScriptReport Robot::run_script(const Lease & lease, const std::string & script, const ScriptOptions & options)
{
  ScriptOptions options_of_holder = options;
  options_of_holder.stop_reason = [permit = lease.permit_, &options]() -> std::optional<Error> {
    if (auto why = permit ? permit->revoked() : std::nullopt) {
      return why;
    }
    return options.stop_reason ? options.stop_reason() : std::nullopt;
  };
  ScriptReport report = impl_->scripts.run(lease.permit_.get(), script, options_of_holder);
  const bool nothing_is_left = report.end == ScriptEnd::finished || report.end == ScriptEnd::rejected ||
                               report.end == ScriptEnd::compile_error;
  if (lease && nothing_is_left) {
    lease.permit_->renew(impl_->generation());  // the script has replaced the control program
  }
  return report;
}

std::vector<std::string> Robot::set_extensions(const std::vector<ScriptExtension> & extensions)
{
  return impl_->control_scripts.set(extensions);
}

Status Robot::has_extension(const std::string & name) const
{
  const auto id = impl_->control_scripts.id(name);
  return id ? Status() : tl::unexpected(id.error());
}

Status Robot::run_extension(const Lease & lease, const std::string & name, const ExtensionOptions & options)
{
  Status result;
  try {
    result = impl_->extensions.run(name, options, permission(lease));
  } catch (...) {  // from ExtensionOptions::stop_reason
    impl_->stopper.end(*lease.permit_, {}).wait();
    throw;
  }
  if (!result && impl_->registers.extension_started()) {
    if (const auto stopped = impl_->stopper.end(*lease.permit_, {}).get(); !stopped) {
      result.error().message += fmt::format("; standstill is not confirmed: {}", stopped.error().message);
    }
  }
  return result;
}

Status Robot::set_input_register(int index, std::int32_t value)
{
  return impl_->registers.set(index, value);
}

Status Robot::set_input_register(int index, double value)
{
  return impl_->registers.set(index, value);
}

int Robot::register_offset() const
{
  return ur_ros_rtde::register_offset(impl_->options);
}

}  // namespace ur_ros_rtde
