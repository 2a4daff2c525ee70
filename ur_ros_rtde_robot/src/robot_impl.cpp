#include "robot_impl.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

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
  result.realtime_priority = options.realtime_priority;
  return result;
}

DashboardConnectionOptions dashboard_options(const RobotOptions & options)
{
  DashboardConnectionOptions result;
  result.address = options.address;
  result.connect_timeout = options.connect_timeout;
  result.retry_interval = options.retry_interval;
  return result;
}

bool is_watchdog_frequency(double frequency)
{
  return frequency >= min_watchdog_frequency && frequency <= max_watchdog_frequency;
}

const RobotOptions & checked(const RobotOptions & options)
{
  if (options.watchdog_frequency != 0.0 && !is_watchdog_frequency(options.watchdog_frequency)) {
    throw std::invalid_argument(
        fmt::format("watchdog_frequency is {} Hz: it must be from {} to {} Hz, or 0 for no watchdog",
                    options.watchdog_frequency, min_watchdog_frequency, max_watchdog_frequency));
  }
  return options;
}

}  // namespace

Robot::Impl::Impl(RobotOptions robot_options, const LogFunction & log)
    : options(checked(robot_options)),
      state(receiver_options(options), log),
      dashboard(dashboard_options(options), log),
      model(options.address, options.model, log),
      control_scripts(options.upper_range_registers),
      interfaces(options, control_scripts, log),
      stopper(options.address, state, interfaces, tracker),
      server(options.urcap_port, options.retry_interval,
             {[this] { return state.version(); },
              [this](const ControllerVersion & version) { return control_scripts.program(version); }},
             log),
      manager(options, state, dashboard, model, interfaces, server, log),
      scripts(options, state, tracker, interfaces, manager),
      extensions(options, state, tracker, interfaces, control_scripts),
      watchdog_frequency_(options.watchdog_frequency)
{
  state.on_link([this](const LinkStatus &) { manager.wake(); });
  state.on_sample([this](const Sample & sample) { add(sample); });
  dashboard.on_link([this](const LinkStatus &) { manager.wake(); });
  server.status_function = [this] { manager.wake(); };
}

void Robot::Impl::add(const Sample & sample)
{
  feed_watchdog(sample);
  tracker.add(sample);
  manager.on_sample(sample);
  if (sample_function) {
    sample_function(sample);
  }
}

/// Driven by the packages, so that the heartbeat ends on a half-open connection.
void Robot::Impl::feed_watchdog(const Sample & sample)
{
  const double frequency = watchdog_frequency_;
  if (frequency == 0.0) {
    return;
  }
  constexpr double kicks_per_period = 5.0;
  const std::chrono::duration<double> interval(1.0 / (kicks_per_period * frequency));
  if (sample.received - last_kick_ >= interval) {
    last_kick_ = sample.received;
    interfaces.kick_watchdog();
  }
}

Status Robot::Impl::set_watchdog(double frequency)
{
  if (!is_watchdog_frequency(frequency)) {
    return failure(ErrorCode::invalid_goal,
                   fmt::format("the watchdog's frequency is {} Hz: it must be from {} to {} Hz", frequency,
                               min_watchdog_frequency, max_watchdog_frequency));
  }
  const auto control = interfaces.control();
  if (!control) {
    return tl::unexpected(unavailable_error());
  }
  watchdog_frequency_ = std::max(watchdog_frequency_.load(), frequency);  // before the program needs it
  if (!(*control)->setWatchdog(frequency)) {
    return failure(ErrorCode::rejected_by_robot, "the control program did not set its watchdog");
  }
  // A restarted program has the watchdog of the options.
  watchdog_frequency_ = std::max(options.watchdog_frequency, frequency);
  return {};
}

Error Robot::Impl::unavailable_error() const
{
  if (manager.control_owner() == ControlOwner::script) {
    return {ErrorCode::busy, "a script runs in place of the control program: wait for its end, or cancel it"};
  }
  const auto status = manager.status();
  if (status.state != RobotState::ready) {
    return {status.cause, status.message};
  }
  return {ErrorCode::not_ready, "the control program is being started"};
}

void Robot::Impl::end_program()
{
  const auto control = interfaces.control();
  if (!control) {
    return;
  }
  if (options.control_mode == ControlMode::control_urcap) {
    // The program must not continue after its External Control node: that might move the arm.
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
    // The watchdog ends it.
  }
}

Robot::Impl::~Impl()
{
  manager.stop();
  if (interfaces.control_interface()) {
    stopper.stop({});
    end_program();
  }
  // Their threads use members that are destroyed before them.
  server.stop();
  state.stop();
  dashboard.stop();
  interfaces.close();
}

}  // namespace ur_ros_rtde
