#include "ur_ros_rtde_robot/robot.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "motion/motion_blocker.hpp"
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

RobotStatus Robot::status() const
{
  return impl_->manager.status();
}

Status Robot::ready_to_move() const
{
  const auto now = status();
  if (now.state != RobotState::ready) {
    return failure(now.cause, now.message);
  }
  return motion_possible();
}

Status Robot::wait_until_ready(std::chrono::milliseconds limit, std::stop_token stop) const
{
  return impl_->manager.wait_until_ready(limit, std::move(stop));
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

Locked<ur_rtde::RTDEControlInterface> Robot::control() const
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

Expected<std::string> Robot::query_dashboard(const std::string & line, std::chrono::milliseconds limit,
                                             const std::stop_token & stop) const
{
  return impl_->dashboard.request(line, limit, stop);
}

std::optional<Sample> Robot::latest() const
{
  return impl_->state.latest();
}

bool Robot::wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop) const
{
  if (!impl_->state.wait_for_next(last, limit, std::move(stop))) {
    return false;
  }
  // The receiving thread may not have done so yet, and the caller asks for motion_progress() next.
  impl_->tracker.add(last);
  return true;
}

Status Robot::motion_possible() const
{
  const auto link = impl_->state.link();
  const auto sample = latest();
  if (!link.connected || !sample) {
    return failure(ErrorCode::link_lost, link.connected
                                             ? "no package from the controller has been received yet"
                                             : link.error.message);
  }
  if (const auto condition = motion_blocker(*sample)) {
    return tl::unexpected(*condition);
  }
  if (impl_->manager.control_owner() == ControlOwner::script) {
    return {};
  }
  if (!sample->program_running()) {
    const char * then = impl_->options.control_mode == ControlMode::upload
                            ? "it is restarted, without resuming the motion, as soon as the robot is ready"
                            : "restart the program with the External Control node";
    return failure(ErrorCode::program_stopped,
                   fmt::format("the control program was stopped (runtime state {}); {}",
                               to_string(sample->runtime_state), then));
  }
  const auto control = impl_->interfaces.control_interface();
  if (!control) {
    auto why = impl_->unavailable_error();
    if (why.code == ErrorCode::not_ready) {  // the connection is being re-established
      why = {ErrorCode::link_lost,
             "the connection to the control program was lost; it is being re-established"};
    }
    return tl::unexpected(std::move(why));
  }
  if (!control->isConnected()) {
    return failure(ErrorCode::link_lost,
                   "the robot closed the connection to the control program; it is being re-established");
  }
  return {};
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

bool Robot::moving() const
{
  const auto view = impl_->tracker.view();
  return !view.at_rest || view.operating();
}

bool Robot::in_freedrive() const
{
  using Control = ur_rtde::RTDEControlInterface;
  const auto control = impl_->interfaces.control_interface();
  return control && (control->getStartedMotions() & (Control::MOTION_FREEDRIVE | Control::MOTION_TEACH)) != 0;
}

Status Robot::set_watchdog(double frequency)
{
  return impl_->set_watchdog(frequency);
}

Expected<StopReport> Robot::stop_motion(const StopOptions & options)
{
  return impl_->stopper.stop(options);
}

ScriptReport Robot::run_script(const std::string & script, const ScriptOptions & options)
{
  return impl_->scripts.run(script, options);
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

Status Robot::run_extension(const std::string & name, const ExtensionOptions & options)
{
  return impl_->extensions.run(name, options);
}

Status Robot::set_input_register(int index, std::int32_t value)
{
  return impl_->extensions.set_input(index, value);
}

Status Robot::set_input_register(int index, double value)
{
  return impl_->extensions.set_input(index, value);
}

int Robot::register_offset() const
{
  return ur_ros_rtde::register_offset(impl_->options);
}

Arbiter & Robot::arbiter()
{
  return impl_->arbiter;
}

}  // namespace ur_ros_rtde
