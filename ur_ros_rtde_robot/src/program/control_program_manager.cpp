// The thread that keeps the control program running, and its interface to other threads.
#include "program/control_program_manager.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "motion/motion_blocker.hpp"
#include "program/program_status.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Stop, start and the check of the result take three passes.
constexpr int passes_per_cycle = 8;

/// Everything that triggers a cycle, in one number.
std::uint64_t modes_of(const Sample & sample)
{
  return static_cast<std::uint64_t>(sample.safety_status_bits) << 32U |
         static_cast<std::uint64_t>(static_cast<std::uint32_t>(sample.robot_mode) & 0xFFU) << 16U |
         static_cast<std::uint64_t>(sample.runtime_state) << 8U | (sample.link & 0xFFU);
}

}  // namespace

ControlProgramManager::ControlProgramManager(const RobotOptions & options, StateReceiver & receiver,
                                             DashboardConnection & dashboard, ArmModel & model,
                                             RtdeInterfaces & interfaces, const ScriptServer & server,
                                             LogFunction log)
    : options_(options),
      receiver_(receiver),
      dashboard_(dashboard),
      model_(model),
      interfaces_(interfaces),
      server_(server),
      logger_(std::move(log)),
      machine_(options.control_mode, options.restart_program),
      status_{RobotState::disconnected, ErrorCode::link_lost,
              fmt::format("connecting to {}", options_.address)},
      state_(machine_.state())
{
}

void ControlProgramManager::start()
{
  if (!thread_.joinable()) {
    thread_ = std::jthread([this] { run(); });
  }
}

void ControlProgramManager::claim()
{
  claimed_ = true;
  wake();
}

void ControlProgramManager::stop()
{
  stop_.request_stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

RobotStatus ControlProgramManager::status() const
{
  const std::lock_guard lock(mutex_);
  return status_;
}

Status ControlProgramManager::wait_until_ready(milliseconds timeout, std::stop_token stop) const
{
  std::unique_lock lock(mutex_);
  if (changed_.wait_for(lock, stop, timeout, [this] { return status_.state == RobotState::ready; })) {
    return {};
  }
  return failure(stop.stop_requested() ? ErrorCode::canceled : status_.cause, status_.message);
}

ControlOwner ControlProgramManager::control_owner() const
{
  return ur_ros_rtde::control_owner(state_);
}

bool ControlProgramManager::has_left_program() const
{
  const ProgramState state = state_;
  return state == ProgramState::ended || state == ProgramState::program_lost ||
         state == ProgramState::orphaned;
}

bool ControlProgramManager::has_foreign_program() const
{
  const ProgramState state = state_;
  return state == ProgramState::foreign || state == ProgramState::idle || state == ProgramState::unclaimed ||
         state == ProgramState::in_use || state == ProgramState::in_use_after_end;
}

std::optional<Error> ControlProgramManager::replacement() const
{
  auto [state, observation] = snapshot();
  if (state != ProgramState::foreign) {
    return std::nullopt;
  }
  observation.remote_control = true;  // the other program has ended the motion, in local control too
  const RobotStatus status =
      program_status(state, observation, receiver_.latest().value_or(Sample{}).runtime_state, options_);
  return Error{status.cause, status.message};
}

std::pair<ProgramState, ProgramObservation> ControlProgramManager::snapshot() const
{
  const std::lock_guard lock(mutex_);
  return {machine_.state(), observation_};
}

void ControlProgramManager::process(ProgramEvent event)
{
  if (const auto action = machine_.process(event, observation_); action != ProgramAction::none) {
    actions_.push_back(action);
  }
  const bool is_replaced = machine_.state() == ProgramState::foreign && state_ != ProgramState::foreign;
  replacements_ += is_replaced ? 1 : 0;
  state_ = machine_.state();
}

void ControlProgramManager::dispatch(ProgramEvent event)
{
  const std::lock_guard lock(mutex_);
  process(event);
}

void ControlProgramManager::on_sample(const Sample & sample)
{
  const Processed now{sample.link, state_, program_activity(sample.runtime_state)};
  // A program that replaces another one leaves no trace in the runtime state.
  const bool heartbeat_lost = now.state == ProgramState::running && sample.is_program_running() &&
                              interfaces_.control_heartbeat_lost();
  if (now.state == ProgramState::yielding && is_pause(sample.runtime_state)) {
    was_paused_ = true;
  }
  if (now != processed_ || heartbeat_lost) {
    const std::lock_guard lock(mutex_);
    if (sample.link == link_) {
      observation_.program = now.program;
      process(heartbeat_lost ? ProgramEvent::heartbeat_lost : ProgramEvent::sample);
      processed_ = {now.link, machine_.state(), now.program};
    }
    wake_ = wake_ || machine_.state() != now.state;
    changed_.notify_all();
  }
  if (const auto modes = modes_of(sample); modes != modes_) {
    modes_ = modes;
    wake();
  }
}

void ControlProgramManager::wake()
{
  {
    const std::lock_guard lock(mutex_);
    wake_ = true;
  }
  changed_.notify_all();
}

void ControlProgramManager::set_status(const RobotStatus & status)
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
    logger_.log(LogLevel::info, "the robot is ready");
  } else if (status.state == RobotState::stopped) {
    logger_.log(LogLevel::warn, fmt::format("the robot cannot move: {}", status.message));
  }
  if (status_function) {
    try {
      status_function(status);
    } catch (const std::exception & error) {
      logger_.log(LogLevel::error, fmt::format("on_status threw: {}", printable(error.what())));
    }
  }
}

std::uint64_t ControlProgramManager::begin_cycle()
{
  const std::lock_guard lock(mutex_);
  wake_ = false;
  return requests_;
}

void ControlProgramManager::finish_cycle(std::uint64_t requests)
{
  {
    const std::lock_guard lock(mutex_);
    if (requests == requests_) {
      process(ProgramEvent::resume_blocked);
    }
    handled_ = requests;
  }
  changed_.notify_all();
}

void ControlProgramManager::run()
{
  const auto stop = stop_.get_token();
  while (!stop.stop_requested()) {
    cycle();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, options_.retry_interval, [this] { return wake_; });
  }
}

void ControlProgramManager::cycle()
{
  const auto requests = begin_cycle();
  if (!claimed_) {
    detect_model();
    return;
  }
  const auto now = examine_guarded();
  if (!stop_.stop_requested()) {
    set_status(now);
    finish_cycle(requests);
  }
}

RobotStatus ControlProgramManager::examine_guarded()
{
  try {
    return examine();
  } catch (const std::exception & error) {
    dispatch(ProgramEvent::start_aborted);
    dispatch(ProgramEvent::yield_failed);
    return {RobotState::connecting, ErrorCode::exception, printable(error.what())};
  }
}

RobotStatus ControlProgramManager::examine()
{
  for (int pass = 0; pass < passes_per_cycle; ++pass) {
    if (auto status = examine_once()) {
      return std::move(*status);
    }
  }
  return {RobotState::connecting, ErrorCode::not_ready, "the program on the robot keeps changing"};
}

ControlProgramManager::Outcome ControlProgramManager::examine_once()
{
  const auto sample = follow_link();
  if (!sample) {
    execute_actions();
    return sample.error();
  }
  const auto blocker = motion_blocker(*sample);
  if (blocker) {
    dispatch(ProgramEvent::yield_rejected);
  }
  if (auto failed = follow_program(!blocker)) {
    return failed;
  }
  if (auto status =
          check_robot(motion_blocker(receiver_.latest().value_or(*sample)))) {  // it may have waited
    return status;
  }
  return claim_robot();
}

tl::expected<Sample, RobotStatus> ControlProgramManager::follow_link()
{
  // Before the sample: a connection is reported after its first sample, so that this one is not older.
  const auto link = receiver_.link();
  const auto sample = receiver_.latest();
  if (!link.connected || !sample) {
    const std::lock_guard lock(mutex_);
    link_ = 0;
    process(ProgramEvent::link_lost);
    return tl::unexpected(
        RobotStatus{RobotState::disconnected, ErrorCode::link_lost,
                    link.connected ? "nothing has come from the controller yet" : link.error.message});
  }
  std::unique_lock lock(mutex_);
  if (link_ != sample->link) {
    process(ProgramEvent::link_lost);
    link_ = sample->link;
    observation_.program = program_activity(sample->runtime_state);
    process(ProgramEvent::link_established);
    process(ProgramEvent::sample);
    lock.unlock();
    execute_actions();
    detect_model();
  }
  return *sample;
}

void ControlProgramManager::detect_model()
{
  const auto sample = receiver_.latest();
  if (receiver_.link().connected && sample && sample->link != model_link_) {
    model_.detect(receiver_.version().value_or(ControllerVersion{}), options_.connect_timeout);
    model_link_ = sample->link;
  }
}

ControlProgramManager::Outcome ControlProgramManager::follow_program(bool robot_can_move)
{
  execute_actions();
  if (const auto control = interfaces_.control_interface();
      state_ == ProgramState::running && control && !control->isConnected()) {
    dispatch(ProgramEvent::control_link_lost);
  }
  // A paused control program must not continue: not after a protective stop has been unlocked, not when the
  // operator presses play.
  dispatch(ProgramEvent::inspection);
  auto failed = execute_actions();
  return robot_can_move ? failed : std::nullopt;
}

ControlProgramManager::Outcome ControlProgramManager::check_robot(const std::optional<Error> & blocker)
{
  if (const auto has = has_dashboard_server(receiver_.version()); !has) {
    return stopped_by(has.error());
  }
  if (const auto io = interfaces_.ensure_io(); !io) {
    auto failed = interface_failed(io.error());
    execute_actions();
    return failed;
  }
  const ProgramState state = state_;
  const auto mismatch = model_.mismatch();
  if (mismatch && state != ProgramState::yielded) {
    return stopped_by(*mismatch);
  }
  if (blocker) {
    return stopped_by(*blocker);
  }
  if (state == ProgramState::running || state == ProgramState::yielding || state == ProgramState::yielded) {
    return RobotStatus{RobotState::ready, ErrorCode::none, {}};
  }
  if (const auto dashboard = dashboard_.link(); !dashboard.connected) {
    return RobotStatus{RobotState::connecting, dashboard.error.code, dashboard.error.message};
  }
  if (options_.control_mode == ControlMode::control_urcap) {
    if (const auto serves = server_.status(); !serves) {
      return stopped_by(serves.error());
    }
  }
  return std::nullopt;
}

ControlProgramManager::Outcome ControlProgramManager::claim_robot()
{
  const bool remote_control = dashboard_.in_remote_control() != false;
  std::pair<ProgramState, ProgramObservation> before;
  {
    const std::lock_guard lock(mutex_);
    observation_.remote_control = remote_control;
    before = {machine_.state(), observation_};
    process(ProgramEvent::robot_ready);
  }
  if (auto failed = execute_actions()) {
    return failed;
  }
  const auto after = snapshot();
  if (after != before) {
    return std::nullopt;
  }
  return program_status(after.first, after.second, receiver_.latest().value_or(Sample{}).runtime_state,
                        options_);
}

}  // namespace ur_ros_rtde
