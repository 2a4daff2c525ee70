#include "ur_ros_rtde_robot/robot.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "robot_impl.hpp"

namespace ur_ros_rtde {

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

LinkStatus Robot::link() const
{
  return impl_->state.link();
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

Locked<ur_rtde::RTDEControlInterface> Robot::control(const Lease & lease)
{
  if (const auto control = impl_->interfaces.control()) {
    return control->permitted_by(permission(lease));
  }
  const bool has_yielded = impl_->manager.control_owner() == ControlOwner::script;
  Status valid = lease && !has_yielded ? is_valid(lease) : Status();
  if (!valid && valid.error().code == ErrorCode::program_stopped) {
    valid = may_continue(lease);  // by the stop that has taken the arm out of the hands of the holder
  }
  throw RobotError(valid ? impl_->unavailable_error() : valid.error());
}

Locked<ur_rtde::RTDEControlInterface> Robot::control_for_queries() const
{
  if (auto control = impl_->interfaces.control_for_queries()) {
    return *std::move(control);
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
  if (const auto has = has_dashboard_server(version()); !has) {
    return tl::unexpected(has.error());
  }
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

Status Robot::set_watchdog(double frequency)
{
  return impl_->set_watchdog(frequency);
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
  // The script has replaced the control program. Nothing else may have ended it.
  if (const Generation now = impl_->generation();
      lease && nothing_is_left && is_continued(lease.permit_->generation())) {
    lease.permit_->renew(now);
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
      result.error() = standstill_not_confirmed(result.error(), stopped.error());
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
