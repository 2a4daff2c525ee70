#include "ur_ros_rtde/robot.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "robot/condition.hpp"
#include "robot/control_scripts.hpp"
#include "robot/extension_runner.hpp"
#include "robot/interface_links.hpp"
#include "robot/motion_stopper.hpp"
#include "robot/motion_tracker.hpp"
#include "robot/script_runner.hpp"
#include "robot/script_server.hpp"
#include "robot/supervisor.hpp"
#include "ur_ros_rtde/dashboard_link.hpp"
#include "ur_ros_rtde/state_receiver.hpp"

namespace ur_ros_rtde {
namespace {

StateReceiverOptions receiver_options(const RobotOptions & options)
{
  StateReceiverOptions result;
  result.address = options.address;
  result.frequency = options.frequency;
  result.connect_timeout = options.connect_timeout;
  result.retry_interval = options.retry_interval;
  result.silence_limit = options.silence_limit;
  result.upper_range_registers = options.upper_range_registers;
  return result;
}

DashboardLinkOptions dashboard_options(const RobotOptions & options)
{
  DashboardLinkOptions result;
  result.address = options.address;
  result.connect_timeout = options.connect_timeout;
  result.retry_interval = options.retry_interval;
  return result;
}

const RobotOptions & checked(const RobotOptions & options)
{
  if (options.watchdog_frequency != 0.0 &&
      !(options.watchdog_frequency >= 1.0 && options.watchdog_frequency <= 50.0)) {
    throw std::invalid_argument(
        fmt::format("watchdog_frequency is {} Hz: it must be from 1 to 50 Hz, or 0 for no watchdog",
                    options.watchdog_frequency));
  }
  return options;
}

}  // namespace

class Robot::Impl {
 public:
  Impl(RobotOptions robot_options, const LogFunction & log)
      : options(checked(robot_options)),
        state(receiver_options(options), log),
        dashboard(dashboard_options(options), log),
        control_scripts(options.upper_range_registers),
        links(options, control_scripts, log),
        stopper(options.address, state, links, tracker),
        server(options.urcap_port, options.retry_interval,
               {[this] { return state.version(); },
                [this](const ControllerVersion & version) { return control_scripts.program(version); }},
               log),
        supervisor(options, state, dashboard, links, log, &server),
        scripts(options, state, tracker, links, supervisor),
        extensions(options, state, tracker, links, control_scripts),
        kicked_for_(options.watchdog_frequency)
  {
    state.on_link([this](const LinkStatus &) { supervisor.look_now(); });
    state.on_sample([this](const Sample & sample) { add(sample); });
    dashboard.on_link([this](const LinkStatus &) { supervisor.look_now(); });
    server.status_function = [this] { supervisor.look_now(); };
  }
  ~Impl();

  void add(const Sample & sample);
  void feed_watchdog(const Sample & sample);
  Status set_watchdog(double frequency);
  Error why_not() const;

  const RobotOptions options;
  Arbiter arbiter;
  std::function<void(const Sample &)> sample_function;
  MotionTracker tracker;
  StateReceiver state;
  DashboardLink dashboard;
  ControlScripts control_scripts;
  InterfaceLinks links;
  MotionStopper stopper;
  ScriptServer server;  ///< for ControlMode::control_urcap
  Supervisor supervisor;
  ScriptRunner scripts;
  ExtensionRunner extensions;

 private:
  void end_program();
  std::chrono::steady_clock::time_point last_kick_{};  ///< receiving thread only
  std::atomic<double> kicked_for_;                     ///< Hz, of the fastest watchdog that may be running
};

void Robot::Impl::add(const Sample & sample)
{
  feed_watchdog(sample);
  tracker.add(sample);
  supervisor.add(sample);
  if (sample_function) {
    sample_function(sample);
  }
}

/// Driven by the packages: a link on which nothing comes any more gives no sign of life either.
void Robot::Impl::feed_watchdog(const Sample & sample)
{
  const double frequency = kicked_for_;
  if (frequency == 0.0) {
    return;
  }
  constexpr double kicks_a_period = 5.0;
  const std::chrono::duration<double> interval(1.0 / (kicks_a_period * frequency));
  if (sample.received - last_kick_ >= interval) {
    last_kick_ = sample.received;
    links.kick_watchdog();
  }
}

Status Robot::Impl::set_watchdog(double frequency)
{
  const auto control = links.control();
  if (!control) {
    return tl::unexpected(why_not());
  }
  kicked_for_ = std::max(kicked_for_.load(), frequency);  // before it is needed
  if (!(*control)->setWatchdog(frequency)) {
    return failure(ErrorCode::rejected_by_robot, "the control program did not set its watchdog");
  }
  // A program that is started anew has the watchdog of the options.
  kicked_for_ = std::max(options.watchdog_frequency, frequency);
  return {};
}

Error Robot::Impl::why_not() const
{
  if (supervisor.gave_way()) {
    return {ErrorCode::busy, "a script runs in place of the control program: wait for its end, or cancel it"};
  }
  const auto status = supervisor.status();
  if (status.state != RobotState::ready) {
    return {status.cause, status.message};
  }
  return {ErrorCode::not_ready, "the control program is being started"};
}

void Robot::Impl::end_program()
{
  const auto control = links.control();
  if (!control) {
    return;
  }
  if (options.control_mode == ControlMode::control_urcap) {
    // What comes behind its External Control node might move the arm.
    const auto ended = stop_program(options.address, std::chrono::milliseconds(500));
    if (ended || options.watchdog_frequency > 0.0) {
      return;
    }
  }
  try {
    const auto held = control->hold();
    held->setCommandTimeout(std::chrono::milliseconds(500));
    held->stopScript();
  } catch (const std::exception &) {
    // The watchdog ends it, then.
  }
}

Robot::Impl::~Impl()
{
  supervisor.stop();
  if (links.control_pointer()) {
    stopper.stop({});
    end_program();
  }
  // Their threads call into the members that are destroyed before them.
  server.stop();
  state.stop();
  dashboard.stop();
  links.drop();
}

Robot::Robot(RobotOptions options, LogFunction log) : impl_(std::make_unique<Impl>(std::move(options), log))
{
}

Robot::~Robot() = default;

void Robot::on_status(std::function<void(const RobotStatus &)> function)
{
  impl_->supervisor.status_function = std::move(function);
}

void Robot::on_sample(std::function<void(const Sample &)> function)
{
  impl_->sample_function = std::move(function);
}

void Robot::start()
{
  impl_->state.start();
  impl_->dashboard.start();
  if (impl_->options.control_mode == ControlMode::control_urcap) {
    impl_->server.start();
  }
  impl_->supervisor.start();
}

RobotStatus Robot::status() const
{
  return impl_->supervisor.status();
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
  return impl_->supervisor.wait_until_ready(limit, std::move(stop));
}

std::optional<ControllerVersion> Robot::version() const
{
  return impl_->state.version();
}

Locked<ur_rtde::RTDEControlInterface> Robot::control() const
{
  if (auto control = impl_->links.control()) {
    return *control;
  }
  throw RobotError(impl_->why_not());
}

Locked<ur_rtde::RTDEReceiveInterface> Robot::receive() const
{
  return impl_->state.receive();
}

Locked<ur_rtde::RTDEIOInterface> Robot::io() const
{
  if (auto io = impl_->links.io()) {
    return *io;
  }
  throw RobotError(impl_->why_not());
}

Locked<ur_rtde::DashboardClient> Robot::dashboard() const
{
  return impl_->dashboard.dashboard();
}

std::optional<Sample> Robot::latest() const
{
  return impl_->state.latest();
}

bool Robot::wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop) const
{
  return impl_->state.wait_for_next(last, limit, std::move(stop));
}

Status Robot::motion_possible() const
{
  const auto link = impl_->state.link();
  const auto sample = latest();
  if (!link.connected || !sample) {
    return failure(ErrorCode::link_lost, link.error.message);
  }
  if (const auto condition = robot_condition(*sample)) {
    return tl::unexpected(*condition);
  }
  if (impl_->supervisor.gave_way()) {
    return {};
  }
  if (!sample->program_running()) {
    const char * then =
        impl_->options.control_mode == ControlMode::upload
            ? "it is started again, without what it was doing, as soon as the robot is ready for it"
            : "start the program with the External Control node again";
    return failure(ErrorCode::program_stopped,
                   fmt::format("the control program was stopped (runtime state {}); {}",
                               to_string(sample->runtime_state), then));
  }
  const auto control = impl_->links.control_pointer();
  if (!control) {
    auto why = impl_->why_not();
    if (why.code == ErrorCode::not_ready) {  // it was there, and is being made anew already
      why = {ErrorCode::link_lost, "the connection to the control program was lost; it is made anew"};
    }
    return tl::unexpected(std::move(why));
  }
  if (!control->isConnected()) {
    return failure(ErrorCode::link_lost,
                   "the robot closed the connection to the control program; it is made anew");
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

bool Robot::guided() const
{
  using Control = ur_rtde::RTDEControlInterface;
  const auto control = impl_->links.control_pointer();
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

Arbiter & Robot::arbiter()
{
  return impl_->arbiter;
}

}  // namespace ur_ros_rtde
