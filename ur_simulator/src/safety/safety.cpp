#include "safety/safety.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ur_simulator {
namespace {

constexpr std::size_t max_events = 256;
constexpr double stop_deceleration = 20.0;  // rad/s^2 of the fastest joint: stops from 3 rad/s in 150 ms
constexpr double steady_delay = 0.5;        // s at standstill

using Level = SafetyEvent::Level;

tl::unexpected<std::string> reject(std::string why)
{
  return tl::unexpected(std::move(why));
}

/// RTDE joint mode (UR, "Real-Time Data Exchange (RTDE) Guide", joint_mode).
std::int32_t joint_mode(RobotMode mode)
{
  switch (mode) {
    case RobotMode::running:
      return 253;
    case RobotMode::idle:
      return 255;
    case RobotMode::booting:
      return 247;
    case RobotMode::power_on:
      return 246;
    case RobotMode::backdrive:
      return 238;
    default:
      return 239;
  }
}

bool is_emergency(SafetyMode mode)
{
  return mode == SafetyMode::robot_emergency_stop || mode == SafetyMode::system_emergency_stop;
}

bool is_failure(SafetyMode mode)
{
  return mode == SafetyMode::violation || mode == SafetyMode::fault;
}

}  // namespace

Safety::Safety(const RobotModel & model, double cycle_time, const SafetyLimits & limits,
               const SafetyTimes & times, const SafetyInputs & inputs)
    : cycle_time_(cycle_time),
      limits_(limits),
      times_(times),
      limit_monitor_(model, cycle_time),
      standstill_time_(steady_delay),
      inputs_(inputs)
{
  safety_mode_ = mode_of_inputs();
}

SafetyMode Safety::undisturbed_mode() const
{
  if (inputs_.safeguard_open) {
    return SafetyMode::safeguard_stop;
  }
  return inputs_.reduced ? SafetyMode::reduced : SafetyMode::normal;
}

SafetyResult Safety::check_power_on() const
{
  const bool restarting = restart_ends_at_ >= 0.0;
  if (is_emergency(safety_mode_)) {
    return reject(fmt::format("cannot power on: safety mode is {}; release the emergency stop",
                              to_string(safety_mode_)));
  }
  if (is_failure(safety_mode_) && !restarting) {
    return reject(fmt::format("cannot power on: safety mode is {}; restart safety", to_string(safety_mode_)));
  }
  return {};
}

SafetyResult Safety::power_on()
{
  if (const auto result = check_power_on(); !result) {
    return result;
  }
  requested_power_ = std::max(requested_power_, Power::idle);
  return {};
}

SafetyResult Safety::brake_release()
{
  if (const auto result = check_power_on(); !result) {
    return result;
  }
  requested_power_ = Power::running;
  return {};
}

SafetyResult Safety::power_off()
{
  requested_power_ = Power::off;
  if (robot_mode_ == RobotMode::power_off) {
    return {};
  }
  actions_.stop_arm = stop_deceleration;
  actions_.stop_program = true;
  power_cut_pending_ = true;
  power_cut_since_ = now_;
  log(Level::information, "powering off");
  return {};
}

SafetyResult Safety::start_running(ControllerState & state)
{
  if (const auto result = check_power_on(); !result) {
    return result;
  }
  requested_power_ = Power::running;
  power_cut_pending_ = false;
  enter(RobotMode::running);
  write(state);
  return {};
}

void Safety::trigger_protective_stop(std::string_view reason, const ErrorCode & code)
{
  if (robot_mode_ != RobotMode::running || stopped()) {
    log(Level::warning, fmt::format("protective stop requested in robot mode {}, safety mode {}: {}",
                                    to_string(robot_mode_), to_string(safety_mode_), reason));
    return;
  }
  stop(SafetyMode::protective_stop, Level::error, fmt::format("protective stop: {}", reason), code);
}

void Safety::trigger_protective_stop(const MotionFault & fault)
{
  trigger_protective_stop(describe(fault), error_code_of(fault));
}

SafetyResult Safety::unlock_protective_stop(UnlockDelay delay)
{
  if (safety_mode_ != SafetyMode::protective_stop) {
    return reject(fmt::format("no protective stop to unlock: safety mode is {}", to_string(safety_mode_)));
  }
  const double left = times_.unlock_delay - (now_ - safety_mode_since_);
  if (delay == UnlockDelay::required && left > 1e-9) {
    return reject(fmt::format(
        "cannot unlock protective stop until {:g} s after it occurred, {:.1f} s are left; inspect the cause",
        times_.unlock_delay, left));
  }
  limit_monitor_.tolerate_present_force();
  enter(undisturbed_mode());
  log(Level::information, "protective stop unlocked");
  return {};
}

void Safety::press_emergency_stop(bool system)
{
  const SafetyMode mode = system ? SafetyMode::system_emergency_stop : SafetyMode::robot_emergency_stop;
  inputs_.emergency_stop = mode;
  if (safety_mode_ != mode && !is_failure(safety_mode_)) {
    stop_and_cut_power(mode, "emergency stop", std::nullopt);
    // `play` continues the motion (ur_dashboard_msgs, SetMode.action; Universal_Robots_ROS_Driver, issue
    // 170).
    actions_.stop_program = false;
    actions_.pause_program = true;
  }
}

SafetyResult Safety::release_emergency_stop()
{
  if (!inputs_.emergency_stop) {
    return reject("no emergency stop is pressed");
  }
  inputs_.emergency_stop.reset();
  if (is_emergency(safety_mode_)) {
    enter(undisturbed_mode());
    log(Level::information, "emergency stop released");
  }
  return {};
}

void Safety::open_safeguard()
{
  inputs_.safeguard_open = true;
  if (allows_motion(safety_mode_)) {
    safeguard_paused_program_ = program_runs_;
    stop(SafetyMode::safeguard_stop, Level::warning, "safeguard stop", std::nullopt);
  }
}

SafetyResult Safety::reset_safeguard()
{
  if (!inputs_.safeguard_open) {
    return reject("the safeguard is closed already");
  }
  inputs_.safeguard_open = false;
  log(Level::information, "safeguard reset");
  if (safety_mode_ == SafetyMode::safeguard_stop) {
    enter(undisturbed_mode());
    actions_.resume_program = std::exchange(safeguard_paused_program_, false);
  }
  return {};
}

SafetyResult Safety::set_reduced(bool reduced)
{
  inputs_.reduced = reduced;
  if (safety_mode_ == SafetyMode::normal || safety_mode_ == SafetyMode::reduced) {
    enter(undisturbed_mode());
  }
  return {};
}

void Safety::trigger_violation(std::string_view reason)
{
  stop_and_cut_power(SafetyMode::violation, fmt::format("safety violation: {}", reason),
                     error_codes::safety_violation);
}

void Safety::trigger_fault(std::string_view reason)
{
  stop_and_cut_power(SafetyMode::fault, fmt::format("safety fault: {}", reason), error_codes::safety_fault);
}

SafetyResult Safety::restart_safety()
{
  if (inputs_.emergency_stop) {
    return reject("cannot restart safety: release the emergency stop first");
  }
  requested_power_ = Power::off;
  power_cut_pending_ = robot_mode_ != RobotMode::power_off;
  power_cut_since_ = now_;
  actions_.stop_arm = stop_deceleration;
  actions_.stop_program = true;
  restart_ends_at_ = now_ + times_.restart;
  log(Level::information, "restarting safety");
  return {};
}

SafetyActions Safety::step(ControllerState & state)
{
  cycle_ = state.cycle;
  now_ = state.timestamp;
  program_runs_ =
      state.runtime_state == RuntimeState::playing || state.runtime_state == RuntimeState::resuming;
  update_standstill(state);
  check_limits(state);
  update_power_cut();
  update_power();
  write(state);
  return std::exchange(actions_, {});
}

std::optional<SafetyEvent> Safety::take_event()
{
  if (events_.empty()) {
    return std::nullopt;
  }
  SafetyEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void Safety::log(SafetyEvent::Level level, std::string message, const std::optional<ErrorCode> & code)
{
  add({cycle_, now_, level, robot_mode_, safety_mode_, std::move(message), code});
}

void Safety::add(SafetyEvent event)
{
  if (events_.size() >= max_events) {
    events_.pop_front();
    ++dropped_events_;
  }
  events_.push_back(std::move(event));
}

void Safety::enter(RobotMode mode)
{
  if (mode == robot_mode_) {
    return;
  }
  robot_mode_ = mode;
  robot_mode_since_ = now_;
  log(Level::information, fmt::format("robot mode {}", to_string(mode)));
}

void Safety::enter(SafetyMode mode)
{
  if (mode == safety_mode_) {
    return;
  }
  safety_mode_ = mode;
  safety_mode_since_ = now_;
  SafetyEvent event{cycle_,       now_,         Level::information,
                    robot_mode_,  safety_mode_, fmt::format("safety mode {}", to_string(mode)),
                    std::nullopt, true};
  add(std::move(event));
}

void Safety::stop(SafetyMode mode, SafetyEvent::Level level, std::string message,
                  const std::optional<ErrorCode> & code)
{
  enter(mode);
  log(level, std::move(message), code);
  actions_.stop_arm = stop_deceleration;
  actions_.pause_program = true;
  actions_.resume_program = false;
}

void Safety::stop_and_cut_power(SafetyMode mode, std::string message, const std::optional<ErrorCode> & code)
{
  stop(mode, Level::error, std::move(message), code);
  safeguard_paused_program_ = false;
  actions_.pause_program = false;
  actions_.stop_program = true;
  requested_power_ = Power::off;
  power_cut_pending_ = robot_mode_ != RobotMode::power_off;
  power_cut_since_ = now_;
}

void Safety::update_power_cut()
{
  if (!power_cut_pending_) {
    return;
  }
  const bool at_standstill = standstill_time_ > 0.0;
  if (robot_mode_ == RobotMode::running && !at_standstill && now_ - power_cut_since_ < times_.stop_limit) {
    return;
  }
  power_cut_pending_ = false;
  enter(RobotMode::power_off);
}

void Safety::update_power()
{
  if (restart_ends_at_ >= 0.0) {
    if (now_ < restart_ends_at_) {
      return;
    }
    restart_ends_at_ = -1.0;
    if (inputs_.emergency_stop) {
      requested_power_ = Power::off;
    }
    enter(mode_of_inputs());
  }
  if (power_cut_pending_) {
    return;
  }
  const double elapsed = now_ - robot_mode_since_;
  if (robot_mode_ == RobotMode::power_off && requested_power_ != Power::off) {
    enter(RobotMode::booting);
  } else if (robot_mode_ == RobotMode::booting && elapsed >= 0.5 * times_.power_on) {
    enter(RobotMode::power_on);
  } else if (robot_mode_ == RobotMode::power_on && elapsed >= 0.5 * times_.power_on) {
    enter(RobotMode::idle);
  } else if (robot_mode_ == RobotMode::idle && requested_power_ == Power::running) {
    if (!releasing_brakes_) {
      releasing_brakes_ = true;
      brake_release_since_ = now_;
    }
    if (now_ - brake_release_since_ >= times_.brake_release) {
      enter(RobotMode::running);
    }
  }
  releasing_brakes_ = releasing_brakes_ && robot_mode_ == RobotMode::idle;
}

void Safety::check_limits(const ControllerState & state)
{
  if (robot_mode_ != RobotMode::running || stopped() || !limits_.monitor) {
    return;
  }
  if (const auto exceeded = limit_monitor_.check(limits_, state)) {
    trigger_protective_stop(exceeded->description, exceeded->code);
  }
}

void Safety::update_standstill(const ControllerState & state)
{
  const bool at_standstill = state.target.velocity.isZero(1e-6) && state.actual.velocity.isZero(1e-4);
  standstill_time_ = at_standstill ? std::min(standstill_time_ + cycle_time_, steady_delay) : 0.0;
}

void Safety::write(ControllerState & state) const
{
  state.robot_mode = robot_mode_;
  state.safety_mode = safety_mode_;
  state.joint_modes.fill(joint_mode(robot_mode_));
  state.steady = standstill_time_ >= steady_delay - 0.5 * cycle_time_;
  state.robot_status_bits = robot_status_bits(robot_mode_, state.runtime_state, state.freedrive);
  state.safety_status_bits = safety_status_bits(safety_mode_);
  state.collision_force_ratio = limit_monitor_.force_ratio();
}

}  // namespace ur_simulator
