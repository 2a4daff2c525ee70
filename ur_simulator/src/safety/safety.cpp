#include "safety/safety.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ur_simulator {
namespace {

constexpr std::size_t kept_events = 256;
constexpr double stop_deceleration = 20.0;  // rad/s^2 of the fastest joint: 3 rad/s come to rest in 150 ms
constexpr double steady_after = 0.5;        // s of standing still

using Level = SafetyEvent::Level;

tl::unexpected<std::string> refuse(std::string why)
{
  return tl::unexpected(std::move(why));
}

/// Joint modes of RTDE (UR, "RTDE Guide", joint_mode).
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
               const SafetyTimes & times)
    : cycle_time_(cycle_time),
      limits_(limits),
      times_(times),
      watch_(model, cycle_time),
      still_for_(steady_after)
{
}

SafetyAnswer Safety::may_power_on() const
{
  if (is_emergency(safety_mode_) || is_failure(safety_mode_)) {
    return refuse(fmt::format("cannot power on: safety mode is {}; {}", to_string(safety_mode_),
                              is_emergency(safety_mode_) ? "release the emergency stop" : "restart safety"));
  }
  if (restart_until_ >= 0.0) {
    return refuse("cannot power on: the safety system restarts");
  }
  return {};
}

SafetyAnswer Safety::power_on()
{
  if (const auto granted = may_power_on(); !granted) {
    return granted;
  }
  wanted_ = std::max(wanted_, Power::idle);
  return {};
}

SafetyAnswer Safety::brake_release()
{
  if (const auto granted = may_power_on(); !granted) {
    return granted;
  }
  wanted_ = Power::running;
  return {};
}

SafetyAnswer Safety::power_off()
{
  wanted_ = Power::off;
  if (robot_mode_ == RobotMode::power_off) {
    return {};
  }
  orders_.halt = stop_deceleration;
  orders_.stop_program = true;
  cutting_power_ = true;
  cut_since_ = now_;
  log(Level::information, "powering off");
  return {};
}

void Safety::start_running(ControllerState & state)
{
  wanted_ = Power::running;
  cutting_power_ = false;
  enter(RobotMode::running);
  write(state);
}

void Safety::trip(std::string_view reason)
{
  if (robot_mode_ != RobotMode::running || stopped()) {
    log(Level::warning, fmt::format("protective stop asked for while {} / {}: {}", to_string(robot_mode_),
                                    to_string(safety_mode_), reason));
    return;
  }
  stop(SafetyMode::protective_stop, Level::error, fmt::format("protective stop: {}", reason));
}

void Safety::trip(const MotionFault & fault)
{
  trip(describe(fault));
}

SafetyAnswer Safety::unlock_protective_stop()
{
  if (safety_mode_ != SafetyMode::protective_stop) {
    return refuse(fmt::format("no protective stop to unlock: safety mode is {}", to_string(safety_mode_)));
  }
  const double left = times_.unlock_delay - (now_ - stop_since_);
  if (left > 1e-9) {
    return refuse(fmt::format(
        "cannot unlock protective stop until {:g} s after it occurred, {:.1f} s are left; inspect the cause",
        times_.unlock_delay, left));
  }
  watch_.relent();
  enter(reduced_ ? SafetyMode::reduced : SafetyMode::normal);
  log(Level::information, "protective stop unlocked");
  return {};
}

void Safety::press_emergency_stop(bool system)
{
  const SafetyMode mode = system ? SafetyMode::system_emergency_stop : SafetyMode::robot_emergency_stop;
  button_pressed_ = mode;
  if (safety_mode_ != mode && !is_failure(safety_mode_)) {
    stop_and_cut_power(mode, "emergency stop");
  }
}

SafetyAnswer Safety::release_emergency_stop()
{
  if (!button_pressed_) {
    return refuse("no emergency stop is pressed");
  }
  button_pressed_.reset();
  if (is_emergency(safety_mode_)) {
    enter(reduced_ ? SafetyMode::reduced : SafetyMode::normal);
    log(Level::information, "emergency stop released");
  }
  return {};
}

void Safety::open_safeguard()
{
  if (allows_motion(safety_mode_)) {
    stop(SafetyMode::safeguard_stop, Level::warning, "safeguard stop");
  }
}

SafetyAnswer Safety::reset_safeguard()
{
  if (safety_mode_ != SafetyMode::safeguard_stop) {
    return refuse(fmt::format("no safeguard stop to reset: safety mode is {}", to_string(safety_mode_)));
  }
  enter(reduced_ ? SafetyMode::reduced : SafetyMode::normal);
  orders_.resume_program = true;
  log(Level::information, "safeguard reset");
  return {};
}

SafetyAnswer Safety::set_reduced(bool reduced)
{
  reduced_ = reduced;
  if (safety_mode_ == SafetyMode::normal || safety_mode_ == SafetyMode::reduced) {
    enter(reduced ? SafetyMode::reduced : SafetyMode::normal);
  }
  return {};
}

void Safety::violate(std::string_view reason)
{
  stop_and_cut_power(SafetyMode::violation, fmt::format("safety violation: {}", reason));
}

void Safety::fail(std::string_view reason)
{
  stop_and_cut_power(SafetyMode::fault, fmt::format("safety fault: {}", reason));
}

SafetyAnswer Safety::restart_safety()
{
  if (button_pressed_) {
    return refuse("cannot restart safety: release the emergency stop first");
  }
  wanted_ = Power::off;
  cutting_power_ = robot_mode_ != RobotMode::power_off;
  cut_since_ = now_;
  orders_.halt = stop_deceleration;
  orders_.stop_program = true;
  restart_until_ = now_ + times_.restart;
  log(Level::information, "restarting safety");
  return {};
}

SafetyOrders Safety::step(ControllerState & state)
{
  cycle_ = state.cycle;
  now_ = state.timestamp;
  watch_rest(state);
  watch_limits(state);
  advance_power_cut();
  advance_power();
  write(state);
  return std::exchange(orders_, {});
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

void Safety::log(SafetyEvent::Level level, std::string message)
{
  if (events_.size() >= kept_events) {
    events_.pop_front();
    ++dropped_;
  }
  events_.push_back({cycle_, now_, level, robot_mode_, safety_mode_, std::move(message)});
}

void Safety::enter(RobotMode mode)
{
  if (mode == robot_mode_) {
    return;
  }
  robot_mode_ = mode;
  mode_since_ = now_;
  log(Level::information, fmt::format("robot mode {}", to_string(mode)));
}

void Safety::enter(SafetyMode mode)
{
  if (mode == safety_mode_) {
    return;
  }
  safety_mode_ = mode;
  stop_since_ = now_;
  log(Level::information, fmt::format("safety mode {}", to_string(mode)));
}

void Safety::stop(SafetyMode mode, SafetyEvent::Level level, std::string message)
{
  enter(mode);
  log(level, std::move(message));
  orders_.halt = stop_deceleration;
  orders_.pause_program = true;
  orders_.resume_program = false;
}

void Safety::stop_and_cut_power(SafetyMode mode, std::string message)
{
  stop(mode, Level::error, std::move(message));
  orders_.pause_program = false;
  orders_.stop_program = true;
  wanted_ = Power::off;
  cutting_power_ = robot_mode_ != RobotMode::power_off;
  cut_since_ = now_;
}

void Safety::advance_power_cut()
{
  if (!cutting_power_) {
    return;
  }
  const bool standing = still_for_ > 0.0;
  if (robot_mode_ == RobotMode::running && !standing && now_ - cut_since_ < times_.stop_limit) {
    return;
  }
  cutting_power_ = false;
  enter(RobotMode::power_off);
}

void Safety::advance_power()
{
  if (restart_until_ >= 0.0) {
    if (now_ < restart_until_) {
      return;
    }
    restart_until_ = -1.0;
    enter(button_pressed_.value_or(reduced_ ? SafetyMode::reduced : SafetyMode::normal));
  }
  if (cutting_power_) {
    return;
  }
  const double waited = now_ - mode_since_;
  if (robot_mode_ == RobotMode::power_off && wanted_ != Power::off) {
    enter(RobotMode::booting);
  } else if (robot_mode_ == RobotMode::booting && waited >= 0.5 * times_.power_on) {
    enter(RobotMode::power_on);
  } else if (robot_mode_ == RobotMode::power_on && waited >= 0.5 * times_.power_on) {
    enter(RobotMode::idle);
  } else if (robot_mode_ == RobotMode::idle && wanted_ == Power::running) {
    if (!releasing_) {
      releasing_ = true;
      release_since_ = now_;
    }
    if (now_ - release_since_ >= times_.brake_release) {
      enter(RobotMode::running);
    }
  }
  releasing_ = releasing_ && robot_mode_ == RobotMode::idle;
}

void Safety::watch_limits(const ControllerState & state)
{
  if (robot_mode_ != RobotMode::running || stopped() || !limits_.monitor) {
    return;
  }
  if (const auto exceeded = watch_.check(limits_, state)) {
    trip(*exceeded);
  }
}

void Safety::watch_rest(const ControllerState & state)
{
  const bool still = state.target.velocity.isZero(1e-6) && state.actual.velocity.isZero(1e-4);
  still_for_ = still ? std::min(still_for_ + cycle_time_, steady_after) : 0.0;
}

void Safety::write(ControllerState & state) const
{
  state.robot_mode = robot_mode_;
  state.safety_mode = safety_mode_;
  state.joint_modes.fill(joint_mode(robot_mode_));
  state.steady = still_for_ >= steady_after - 0.5 * cycle_time_;
  state.robot_status_bits = robot_status_bits(robot_mode_, state.runtime_state, state.freedrive);
  state.safety_status_bits = safety_status_bits(safety_mode_);
}

}  // namespace ur_simulator
