#include "robot_impl.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "connection/dashboard_request.hpp"

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
  if (const auto problem = watchdog_frequency_problem(options.watchdog_frequency); !problem.empty()) {
    throw std::invalid_argument(problem);
  }
  return options;
}

Error control_connection_lost()
{
  return {ErrorCode::link_lost, "the connection to the control program was lost; it is being re-established"};
}

}  // namespace

std::string watchdog_frequency_problem(double frequency)
{
  if (frequency == 0.0 || is_watchdog_frequency(frequency)) {
    return {};
  }
  return fmt::format("watchdog_frequency is {} Hz: it must be from {} to {} Hz, or 0 for no watchdog",
                     frequency, min_watchdog_frequency, max_watchdog_frequency);
}

Robot::Impl::Impl(RobotOptions robot_options, const LogFunction & log)
    : options(checked(robot_options)),
      tracker([this] {
        return interfaces.has_lost_control() ? std::optional(control_connection_lost()) : std::nullopt;
      }),
      state(receiver_options(options), log),
      dashboard(dashboard_options(options), log),
      model(options.address, options.model, log),
      control_scripts(options, log),
      interfaces(options, control_scripts, log),
      registers(options, interfaces),
      activities(interfaces, registers, tracker),
      stopper(
          options, state, interfaces, registers, tracker, activities, arbiter,
          {[this] { return manager.has_left_program(); }, [this] { return manager.has_foreign_program(); }},
          log),
      server(options.urcap_port, options.retry_interval,
             {[this] { return state.version(); },
              [this](const ControllerVersion & version) {
                control_scripts.leave_out_unfit(version);
                return control_scripts.program(version);
              }},
             log),
      manager(options, state, dashboard, model, interfaces, server, log),
      scripts(
          options, state, tracker, activities, stopper, manager, [this] { return generation(); },
          [this] { return interfaces.has_lost_control(); }),
      extensions(options, state, tracker, registers, control_scripts),
      log_(log),
      watchdog_frequency_(options.watchdog_frequency)
{
  state.on_link([this](const LinkStatus &) { manager.wake(); });
  state.on_sample([this](const Sample & sample) { add(sample); });
  dashboard.on_link([this](const LinkStatus &) { manager.wake(); });
  server.status_function = [this] { manager.wake(); };
}

void Robot::Impl::add(const Sample & sample)
{
  tracker.add(sample);
  feed_watchdog(sample);
  warn_of_zeroed_force(zeroed_force_.add(sample));
  manager.on_sample(sample);
  if (sample_function) {
    sample_function(sample);
  }
}

void Robot::Impl::warn_of_zeroed_force(double force) const
{
  constexpr double contact = 10.0;  // N, above the noise and a slightly wrong payload
  if (force > contact && !state.version().value_or(ControllerVersion{}).cb3()) {
    log_(LogLevel::warn, fmt::format("the start of a program has zeroed the force sensor, which measured "
                                     "{:.0f} N: forces are relative to that. Without contact, check the "
                                     "payload (set_payload) and call zero_ft_sensor",
                                     force));
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
  if (!interfaces.control()) {
    return tl::unexpected(unavailable_error());
  }
  watchdog_frequency_ = std::max(watchdog_frequency_.load(), frequency);  // before the program needs it
  if (Status set = interfaces.set_watchdog(frequency); !set) {
    return set;
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

Error Robot::Impl::program_ended_error() const
{
  if (Error cause = tracker.end_cause(); cause.code != ErrorCode::none) {
    return cause;
  }
  const char * then = options.control_mode == ControlMode::upload
                          ? "it is restarted, without resuming the motion, as soon as the robot is ready"
                          : "restart the program with the External Control node";
  const double frequency = interfaces.watchdog_frequency();
  if (const double gap = tracker.view().gap; frequency > 0.0 && gap > 1.0 / frequency) {
    return stopped_by_watchdog("the control program", gap, frequency, then);
  }
  std::string by = frequency > 0.0
                       ? "on the pendant, by another client, by an error (see the pendant's log), or "
                         "by its watchdog if the connection to it is interrupted"
                       : "on the pendant, by another client, or by an error (see the pendant's log)";
  if (const Sample now = state.latest().value_or(Sample{}); !now.is_program_running()) {  // not the next one
    by += fmt::format(" (runtime state {})", to_string(now.runtime_state));
  }
  return {ErrorCode::program_stopped, fmt::format("the control program was stopped {}; {}", by, then)};
}

Status Robot::Impl::motion_possible() const
{
  const auto control = interfaces.control_interface();
  const bool has_control = control && control->isConnected();
  const auto link = state.link();
  const auto sample = state.latest();  // last, because the manager disconnects when a sample ends the program
  if (!link.connected || !sample) {
    return failure(ErrorCode::link_lost, link.connected
                                             ? "no package from the controller has been received yet"
                                             : link.error.message);
  }
  if (const auto condition = motion_blocker(*sample)) {
    return tl::unexpected(*condition);
  }
  if (manager.control_owner() == ControlOwner::script) {
    return {};
  }
  if (!sample->is_program_running()) {
    tracker.add(*sample);  // the receiving thread may not have done so yet: the cause would be an earlier one
    return tl::unexpected(program_ended_error());
  }
  if (!control || (!has_control && interfaces.control_interface() != control)) {  // closed by the driver
    if (auto why = manager.replacement()) {
      return tl::unexpected(*std::move(why));
    }
    auto why = unavailable_error();
    if (why.code == ErrorCode::not_ready) {  // the connection is being re-established
      why = control_connection_lost();
    }
    return tl::unexpected(std::move(why));
  }
  if (!has_control) {
    return tl::unexpected(control_connection_lost());
  }
  return {};
}

Status Robot::Impl::ready_to_move() const
{
  const RobotStatus now = manager.status();
  if (now.state != RobotState::ready) {
    return failure(now.cause, now.message);
  }
  return motion_possible();
}

Generation Robot::Impl::generation() const
{
  const auto view = tracker.view();
  const auto starts = interfaces.starts();
  return {.ends = view.program,
          .starts = starts.number,
          .link = view.link,
          .robot_stops = view.robot_stops,
          .ended_by_driver = stopper.ended_programs() + scripts.ended_programs(),
          .restarted_by_driver = starts.after_script,
          .failed_starts = interfaces.failed_starts(),
          .replacements = manager.replacements()};
}

Status Robot::Impl::may_use(const Claim & claim) const
{
  if (!moves_arm(claim.resource)) {
    const RobotStatus status = manager.status();
    const bool connected = status.state == RobotState::ready || status.state == RobotState::stopped;
    return connected ? Status()
                     : failure(status.cause == ErrorCode::none ? ErrorCode::not_ready : status.cause,
                               status.message);
  }
  if (Status ready = ready_to_move(); !ready) {
    return ready;
  }
  if (!claim.switches_hand_guiding && activities.now().contains_any(hand_guiding)) {
    return failure(ErrorCode::busy,
                   "the arm is in freedrive or teach mode and may be moved by hand: end the mode first "
                   "(freedrive_stop, end_teach_mode, stop)");
  }
  return {};
}

Status Robot::Impl::leaves_force_mode_alone(const Claim & claim) const
{
  const bool is_script = claim.resource == Resource::script;
  if ((!is_script && !claim.excludes_force_mode) || !activities.now().contains(Activity::force_mode)) {
    return {};
  }
  return failure(
      ErrorCode::busy,
      fmt::format(
          "force mode is active, and {} would {}: end it first (force_mode_stop, stop)", claim.owner,
          is_script ? "end it and go on without compliance" : "change the force with which the arm presses"));
}

/// For a moment. False after `deadline`, and when the state of the robot keeps the program from running.
bool Robot::Impl::wait_for_control_program(Permit::Clock::time_point deadline) const
{
  auto sample = state.latest();
  if (!sample || !state.link().connected || motion_blocker(*sample) || Permit::Clock::now() > deadline) {
    return false;
  }
  state.wait_for_next(*sample, std::chrono::milliseconds(20));
  return true;
}

Expected<Generation> Robot::Impl::admit(const Claim & claim) const
{
  const Generation now = generation();  // before the checks: a change afterwards ends the lease
  if (Status usable = may_use(claim); !usable) {
    return tl::unexpected(usable.error());
  }
  if (Status possible = leaves_force_mode_alone(claim); !possible) {
    return tl::unexpected(possible.error());
  }
  if (moves_arm(claim.resource) && stopper.is_stopping()) {
    return failure(ErrorCode::busy, "the arm is being stopped: wait until it is at rest");
  }
  if (moves_arm(claim.resource) && manager.control_owner() == ControlOwner::script) {
    return tl::unexpected(unavailable_error());  // its goal has ended, its thread has not
  }
  return now;
}

void Robot::Impl::end_program()
{
  const auto control = interfaces.control();
  if (!control) {
    return;
  }
  bool ended = false;
  try {
    const auto held = control->hold();
    held->setCommandTimeout(std::chrono::milliseconds(500));
    ended = held->stopScript();
  } catch (const std::exception &) {
    // It may have ended by itself.
  }
  if (!ended && interfaces.watchdog_frequency() == 0.0) {
    std::ignore = stop_program(options.address, std::chrono::milliseconds(500));  // nothing else would end it
  }
}

Robot::Impl::~Impl()
{
  const auto stop = [this] {
    return interfaces.control_interface()
               ? stopper.begin({}, Error{ErrorCode::shutdown, "the driver is shutting down"})
               : Stopping();
  };
  auto stopping = stop();  // now: the end of the manager's thread takes time
  manager.stop();
  if (!stopping.valid()) {
    stopping = stop();  // of a program that the manager has just started
  }
  if (stopping.valid()) {
    stopping.wait();  // the stopper logs a failure
    end_program();
  }
  stopper.close();
  // Their threads use members that are destroyed before them.
  server.stop();
  state.stop();
  dashboard.stop();
  interfaces.close();
}

}  // namespace ur_ros_rtde
