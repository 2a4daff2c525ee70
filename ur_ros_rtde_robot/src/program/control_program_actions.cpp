// The actions of the control program's state machine.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "connection/dashboard_request.hpp"
#include "connection/skew.hpp"
#include "motion/motion_blocker.hpp"
#include "program/control_program_manager.hpp"
#include "program/program_status.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds program_begin_timeout(500);
constexpr milliseconds program_end_timeout(1000);
constexpr milliseconds heartbeat_wait_timeout(500);
constexpr milliseconds hold_timeout(1000);

bool closes_interface(ProgramAction action)
{
  return action == ProgramAction::close_control || action == ProgramAction::close_interfaces;
}

/// The table asks for `action` in this state. The receiving thread may have left the state that asked for it.
bool permits(ProgramState state, ProgramAction action)
{
  const auto table = program_transitions();
  return std::any_of(table.begin(), table.end(), [&](const ProgramTransition & transition) {
    return transition.to == state && transition.action == action;
  });
}

}  // namespace

std::optional<ProgramAction> ControlProgramManager::next_action()
{
  const std::lock_guard lock(mutex_);
  if (actions_.empty()) {
    return std::nullopt;
  }
  const auto action = actions_.front();
  actions_.erase(actions_.begin());
  return action;
}

ControlProgramManager::Outcome ControlProgramManager::execute_actions()
{
  Outcome failed;
  while (const auto action = next_action()) {
    try {
      if (auto outcome = execute(*action)) {
        failed = std::move(outcome);
      }
    } catch (...) {
      if (closes_interface(*action)) {  // has to be done before anything else
        const std::lock_guard lock(mutex_);
        actions_.insert(actions_.begin(), *action);
      }
      throw;
    }
  }
  return failed;
}

ControlProgramManager::Outcome ControlProgramManager::execute(ProgramAction action)
{
  switch (action) {
    case ProgramAction::none:
      return std::nullopt;
    case ProgramAction::close_control:
      interfaces_.close_control();
      return std::nullopt;
    case ProgramAction::close_interfaces:
      interfaces_.close();
      return std::nullopt;
    default:
      break;
  }
  if (!permits(state_, action)) {
    return std::nullopt;
  }
  switch (action) {
    case ProgramAction::stop_program:
      return stop_program_on_robot();
    case ProgramAction::start_program:
      return start_program();
    case ProgramAction::connect_control:
      return connect_control();
    case ProgramAction::adopt_program:
      return adopt_program();
    case ProgramAction::suspend_program:
      suspend_program();
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

RobotStatus ControlProgramManager::interface_failed(const Error & error)
{
  if (error.code != ErrorCode::robot_in_use) {
    return {RobotState::connecting, error.code, error.message};
  }
  dispatch(ProgramEvent::inputs_in_use);
  return {RobotState::stopped, error.code, error.message};
}

ControlProgramManager::Outcome ControlProgramManager::start_program()
{
  wait_after_failed_start();
  wait_while_held();
  if (const auto blocker = motion_blocker(receiver_.latest().value_or(Sample{}))) {
    dispatch(ProgramEvent::start_aborted);
    return stopped_by(*blocker);
  }
  if (snapshot().second.program != ProgramActivity::stopped) {  // another one has begun, and may be paused
    dispatch(ProgramEvent::start_aborted);
    return std::nullopt;
  }
  if (!interfaces_.has_pending_control()) {
    set_status({RobotState::connecting, ErrorCode::not_ready, "starting the control program"});
  }
  const auto start = [this] {
    return interfaces_.start_control(receiver_.version().value_or(ControllerVersion{}), stop_.get_token());
  };
  auto started = start();
  // A program has begun in between. After the end of the control program, it is a foreign one.
  const bool overtaken = !started && started.error().code == ErrorCode::program_stopped;
  if (overtaken && state_ != ProgramState::restarting && end_program()) {
    started = start();
  }
  if (!started) {
    auto failed = interface_failed(started.error());
    // No effect after inputs_in_use.
    const bool rejected = started.error().code == ErrorCode::not_ready;
    if (rejected && next_start_ == Clock::time_point{} && !stop_.stop_requested()) {
      logger_.log(LogLevel::warn, fmt::format("the control program cannot be started: {}; trying again",
                                              started.error().message));
    }
    next_start_ = Clock::now() + options_.retry_interval;
    dispatch(rejected ? ProgramEvent::start_failed : ProgramEvent::start_aborted);
    return failed;
  }
  if (!wait_for_program(ProgramActivity::playing, program_begin_timeout)) {
    interfaces_.close_control();
    next_start_ = Clock::now() + options_.retry_interval;
    dispatch(ProgramEvent::start_failed);
    return RobotStatus{RobotState::connecting, ErrorCode::not_ready,
                       "the control program ended at once: look at the pendant's log"};
  }
  next_start_ = {};
  dispatch(ProgramEvent::program_started);
  return std::nullopt;
}

void ControlProgramManager::wait_after_failed_start()
{
  // A failed start changes the state of the robot's program, which would trigger the next one at once.
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, stop_.get_token(), next_start_, [] { return false; });
}

void ControlProgramManager::wait_while_held()
{
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop_.get_token(), hold_timeout, [this] { return holds_ == 0; });
}

ControlProgramManager::Outcome ControlProgramManager::stop_program_on_robot()
{
  const auto ended = end_program();
  if (ended) {
    return std::nullopt;
  }
  if (options_.control_mode == ControlMode::upload || state_ != ProgramState::orphaned) {
    return RobotStatus{RobotState::stopped, ended.error().code, ended.error().message};
  }
  // In local control, its watchdog has to end it. A link that is lost meanwhile says nothing about the stop.
  if (follows_newest_link()) {
    return std::nullopt;
  }
  return RobotStatus{RobotState::connecting, ErrorCode::not_ready,
                     "stopping the program that the lost link left"};
}

Status ControlProgramManager::end_program()
{
  const auto runtime = receiver_.latest().value_or(Sample{}).runtime_state;
  if (runtime != RuntimeState::stopped) {
    constexpr milliseconds answer_timeout(2000);
    if (auto sent = stop_program(options_.address, answer_timeout); !sent) {
      return failure(ErrorCode::program_stopped,
                     fmt::format("a program of the robot ({}) cannot be stopped: {}", to_string(runtime),
                                 sent.error().message));
    }
  }
  if (!wait_for_program(ProgramActivity::stopped, program_end_timeout)) {
    return failure(ErrorCode::program_stopped, "the robot does not stop its program: stop it on the pendant");
  }
  if (runtime == RuntimeState::playing) {
    logger_.log(LogLevel::warn,
                "a program was running on the robot: stopped it to start the control program");
  }
  return {};
}

bool ControlProgramManager::follows_newest_link() const
{
  const bool connected = receiver_.link().connected;
  const auto latest = receiver_.latest();
  const std::lock_guard lock(mutex_);
  return connected && latest && latest->link == link_;
}

bool ControlProgramManager::wait_for_program(ProgramActivity program, milliseconds timeout) const
{
  return wait_for_program([program](ProgramActivity now) { return now == program; }, timeout);
}

bool ControlProgramManager::wait_while_program_plays(milliseconds timeout) const
{
  return wait_for_program([](ProgramActivity now) { return now != ProgramActivity::playing; }, timeout);
}

bool ControlProgramManager::wait_for_program(const std::function<bool(ProgramActivity)> & condition,
                                             milliseconds timeout) const
{
  constexpr milliseconds link_check_interval(50);
  const auto stop = stop_.get_token();
  const auto deadline = Clock::now() + timeout;
  const auto reached = [&] { return condition(observation_.program); };
  while (Clock::now() < deadline && !stop.stop_requested() && follows_newest_link()) {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, stop, link_check_interval, reached)) {
      return true;
    }
  }
  return false;
}

void ControlProgramManager::suspend_program()
{
  const auto yielded = [this] {  // an operator who has paused the program wants the arm to rest
    dispatch(was_paused_ ? ProgramEvent::yield_failed : ProgramEvent::program_yielded);
  };
  if (interfaces_.suspend_control() && wait_for_program(ProgramActivity::stopped, program_end_timeout)) {
    yielded();
    return;
  }
  // The samples come over another connection than what the control interface has seen, and may be late.
  const bool is_stopped = wait_for_program(ProgramActivity::stopped, max_skew);
  if (is_stopped || was_paused_ || !interfaces_.pending_program_plays()) {
    wait_while_program_plays(program_end_timeout);
    dispatch(ProgramEvent::yield_failed);  // something else has stopped it; another program may have run
    return;
  }
  if (interfaces_.control_heartbeat_lost()) {
    dispatch(ProgramEvent::heartbeat_lost);
    return;
  }
  if (end_program()) {
    yielded();
  } else {
    dispatch(ProgramEvent::yield_failed);
  }
}

ControlProgramManager::Outcome ControlProgramManager::connect_control()
{
  if (const auto connected = interfaces_.connect_pending_control(); !connected) {
    return interface_failed(connected.error());
  }
  return std::nullopt;
}

ControlProgramManager::Outcome ControlProgramManager::adopt_program()
{
  if (auto failed = connect_control()) {
    return failed;
  }
  if (!interfaces_.pending_program_alive(heartbeat_wait_timeout, stop_.get_token())) {
    return program_stopped(fmt::format(
        "a program runs on the robot, but not the control program: {}",
        server_.fetched() == 0
            ? fmt::format(
                  "the External Control URCap has not fetched it from port {}. Check that the program "
                  "has an External Control node, and that Host IP in the URCap's installation is the "
                  "address of this host",
                  options_.urcap_port)
            : std::string("the program has not reached its External Control node, has already passed it, or "
                          "is a different program")));
  }
  if (const auto adopted = interfaces_.adopt_control(); !adopted) {
    return RobotStatus{RobotState::connecting, adopted.error().code, adopted.error().message};
  }
  dispatch(ProgramEvent::program_adopted);
  return std::nullopt;
}

}  // namespace ur_ros_rtde
