#include "program/supervisor.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "motion/motion_stopper.hpp"
#include "program/condition.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds first_package_limit(100);

RobotStatus stopped(const Error & error)
{
  return {RobotState::stopped, error.code, error.message};
}

/// All that the supervisor decides by, in one number.
std::uint64_t modes(const Sample & sample)
{
  return static_cast<std::uint64_t>(sample.safety_status_bits) << 32U |
         static_cast<std::uint64_t>(static_cast<std::uint32_t>(sample.robot_mode) & 0xFFU) << 16U |
         static_cast<std::uint64_t>(sample.runtime_state) << 8U | (sample.link & 0xFFU);
}

}  // namespace

const char * to_string(RobotState state)
{
  switch (state) {
    case RobotState::disconnected:
      return "disconnected";
    case RobotState::connecting:
      return "connecting";
    case RobotState::ready:
      return "ready";
    case RobotState::stopped:
      return "stopped";
  }
  return "unknown";
}

Supervisor::Supervisor(const RobotOptions & options, StateReceiver & state, DashboardLink & dashboard,
                       ArmModel & model, InterfaceLinks & links, LogFunction log, const ScriptServer * server)
    : options_(options),
      state_(state),
      dashboard_(dashboard),
      model_(model),
      links_(links),
      report_(std::move(log)),
      server_(server)
{
  status_ = {RobotState::disconnected, ErrorCode::link_lost,
             fmt::format("connecting to {}", options_.address)};
}

void Supervisor::start()
{
  thread_ = std::jthread([this](const std::stop_token & stop) { run(stop); });
}

void Supervisor::stop()
{
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
}

RobotStatus Supervisor::status() const
{
  const std::lock_guard lock(mutex_);
  return status_;
}

Status Supervisor::wait_until_ready(milliseconds limit, std::stop_token stop) const
{
  std::unique_lock lock(mutex_);
  if (changed_.wait_for(lock, stop, limit, [this] { return status_.state == RobotState::ready; })) {
    return {};
  }
  return failure(stop.stop_requested() ? ErrorCode::canceled : status_.cause, status_.message);
}

void Supervisor::add(const Sample & sample)
{
  // A program that takes the place of another one leaves no trace in the runtime state.
  if (program_ours_ && (!sample.program_running() || links_.control_silent())) {
    program_ours_ = false;
    look_now();
  }
  if (sample.runtime_state == RuntimeState::stopped) {
    begins_afresh_ = true;
  }
  if (const auto now = modes(sample); now != seen_) {
    seen_ = now;
    look_now();
  }
}

void Supervisor::look_now()
{
  {
    const std::lock_guard lock(mutex_);
    look_requested_ = true;
  }
  changed_.notify_all();
}

void Supervisor::set(const RobotStatus & status)
{
  {
    const std::lock_guard lock(mutex_);
    if (status_.state == status.state && status_.cause == status.cause && status_.message == status.message) {
      return;
    }
    status_ = status;
  }
  changed_.notify_all();
  if (status.state == RobotState::ready) {
    report_.say(LogLevel::info, "the robot is ready");
  } else if (status.state == RobotState::stopped) {
    report_.say(LogLevel::warn, fmt::format("the robot cannot move: {}", status.message));
  }
  if (status_function) {
    status_function(status);
  }
}

void Supervisor::run(const std::stop_token & stop)
{
  while (!stop.stop_requested()) {
    RobotStatus now;
    try {
      now = look();
    } catch (const std::exception & error) {
      now = {RobotState::connecting, ErrorCode::exception, printable(error.what())};
    }
    if (stop.stop_requested()) {
      return;
    }
    set(now);
    settle_turn(now);
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, options_.retry_interval, [this] { return look_requested_; });
    look_requested_ = false;
  }
}

RobotStatus Supervisor::look()
{
  begin_look();
  const auto link = state_.link();
  auto sample = state_.latest();
  // The link is made anew, but its first package may not have come: what the last one before tells is over.
  if (link.connected && sample && sample->link == lost_link_ &&
      !state_.wait_for_next(*sample, first_package_limit)) {
    return {RobotState::connecting, ErrorCode::link_lost, "nothing has come over the new connection yet"};
  }
  if (!link.connected || !sample) {
    lost_link_ = sample ? sample->link : lost_link_;
    forget_program();
    links_.drop();
    return {RobotState::disconnected, ErrorCode::link_lost,
            link.connected ? "nothing has come from the controller yet" : link.error.message};
  }
  if (std::exchange(link_, sample->link) != sample->link) {
    forget_program();
    program_ended_ = false;
    links_.drop();
    model_.detect(state_.version().value_or(ControllerVersion{}), options_.connect_timeout);
  }
  if (const auto control = links_.control_pointer(); program_ours_ && control && !control->isConnected()) {
    // Only this link is lost; the program behind it, still ours, is replaced.
    forget_program();
    links_.drop_control();
  }
  const auto condition = robot_condition(*sample);
  if (turn_at_look_ == Turn::others || (turn_at_look_ == Turn::asked_for && program_ours_)) {
    return look_at_turn(*sample, condition);
  }
  if (!program_ours_ && links_.control_pointer()) {
    // Whatever ended it, it must not go on from where it was: not after a protective stop is unlocked, not on
    // the pendant's play.
    program_ended_ = true;
    fetched_ran_ = false;
    links_.drop_control();
    sample = state_.latest().value_or(*sample);  // that took time, in which the program may have ended
  }
  if (!program_ours_ && program_ended_ && !begins_afresh_ && sample->runtime_state != RuntimeState::stopped &&
      !sample->program_running()) {
    if (const auto ended = stop_other_program(*sample); !ended && !condition) {
      return stopped(ended.error());
    }
    sample = state_.latest().value_or(*sample);
  }
  if (const auto io = links_.ensure_io(); !io) {
    return not_made(io.error());
  }
  if (const auto mismatch = model_.mismatch()) {
    return stopped(*mismatch);
  }
  if (condition) {
    return stopped(*condition);
  }
  return look_at_program(*sample);
}

RobotStatus Supervisor::not_made(const Error & error)
{
  if (error.code != ErrorCode::robot_in_use) {
    return {RobotState::connecting, error.code, error.message};
  }
  was_in_use_ = true;
  return stopped(error);
}

std::optional<Error> Supervisor::program_of_another_driver(const Sample & sample)
{
  was_in_use_ = was_in_use_ && sample.runtime_state != RuntimeState::stopped;
  if (!was_in_use_) {
    return std::nullopt;
  }
  links_.drop();  // if the other one has only lost a connection, it gets the robot back
  return Error{ErrorCode::robot_in_use,
               "another driver has left the robot, but not its program: if that does not end by itself, stop "
               "it (dashboard/stop, or on the pendant)"};
}

RobotStatus Supervisor::look_at_program(const Sample & sample)
{
  if (program_ours_) {
    was_in_use_ = false;
    return {RobotState::ready, ErrorCode::none, {}};
  }
  if (const auto dashboard = dashboard_.link(); !dashboard.connected) {
    return {RobotState::connecting, dashboard.error.code, dashboard.error.message};
  }
  if (options_.control_mode == ControlMode::control_urcap) {
    return look_at_fetched_program(sample);
  }
  if (const auto other = program_of_another_driver(sample)) {
    return stopped(*other);
  }
  if (dashboard_.in_remote_control() == false) {
    return stopped(
        {ErrorCode::not_ready,
         "the robot is in local control and takes no program from here: choose remote control on the pendant "
         "(enabled under Settings, System, Remote Control)"});
  }
  if (const auto other = other_program(sample)) {
    return stopped(*other);
  }
  if (program_ended_ && !options_.restart_program) {
    return stopped({ErrorCode::program_stopped,
                    "the control program was stopped, and restart_program is off: start the driver again"});
  }
  if (const auto ended = stop_other_program(sample); !ended) {
    return stopped(ended.error());
  }
  return start_program();
}

std::optional<Error> Supervisor::other_program(const Sample & sample)
{
  start_failed_ = start_failed_ && sample.runtime_state != RuntimeState::stopped;
  if (!program_ended_ || start_failed_) {
    return std::nullopt;
  }
  if (sample.program_running()) {
    begins_afresh_ = true;
  }
  // Ours, paused, is stopped by look(): one that is not stopped here began after it.
  if (!begins_afresh_ || sample.runtime_state == RuntimeState::stopped) {
    return std::nullopt;
  }
  return Error{ErrorCode::program_stopped,
               fmt::format("another program {} on the robot and has replaced the control program: stop it "
                           "(dashboard/stop)",
                           sample.program_running() ? "runs" : "is paused")};
}

Status Supervisor::stop_other_program(const Sample & sample)
{
  if (sample.runtime_state == RuntimeState::stopped) {
    return {};
  }
  if (sample.program_running()) {
    report_.say(LogLevel::warn,
                "a program was running on the robot: stopped it to start the control program");
  }
  if (auto status = stop_program(options_.address, milliseconds(500)); !status) {
    return failure(ErrorCode::program_stopped,
                   fmt::format("a program of the robot ({}) cannot be stopped: {}",
                               to_string(sample.runtime_state), status.error().message));
  }
  if (!wait_for_runtime(RuntimeState::stopped, milliseconds(1000))) {
    return failure(ErrorCode::program_stopped, "the robot does not stop its program: stop it on the pendant");
  }
  return {};
}

RobotStatus Supervisor::start_program()
{
  if (!links_.control_parked()) {
    set({RobotState::connecting, ErrorCode::not_ready, "starting the control program"});
  }
  if (const auto started = links_.start_control(state_.version().value_or(ControllerVersion{})); !started) {
    if (started.error().code == ErrorCode::robot_in_use) {
      links_.drop();  // also the IO interface: whoever has the control program gets all of the robot
    }
    start_failed_ = started.error().code == ErrorCode::not_ready;
    return not_made(started.error());
  }
  if (!wait_for_runtime(RuntimeState::playing, milliseconds(500))) {
    links_.drop_control();
    start_failed_ = true;
    return {RobotState::connecting, ErrorCode::not_ready,
            "the control program ended at once: look at the pendant's log"};
  }
  begins_afresh_ = false;
  program_ours_ = true;
  program_ended_ = false;
  start_failed_ = false;
  return {RobotState::ready, ErrorCode::none, {}};
}

bool Supervisor::wait_for_runtime(RuntimeState runtime, milliseconds limit) const
{
  const auto deadline = std::chrono::steady_clock::now() + limit;
  Sample sample = state_.latest().value_or(Sample{});
  while (sample.runtime_state != runtime) {
    if (std::chrono::steady_clock::now() > deadline || !state_.link().connected) {
      return false;
    }
    state_.wait_for_next(sample, milliseconds(50));
  }
  return true;
}

}  // namespace ur_ros_rtde
