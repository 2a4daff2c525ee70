#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "kinematics/robot_model.hpp"
#include "safety/event.hpp"
#include "safety/limits.hpp"
#include "safety/watch.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// What the rest of the controller has to do this cycle because of safety.
struct SafetyOrders {
  std::optional<double> halt;   ///< Arm::halt() with this deceleration, rad/s^2
  bool pause_program = false;   ///< protective or safeguard stop began: a running program is PAUSED
  bool resume_program = false;  ///< safeguard was reset
  bool stop_program = false;    ///< emergency stop, violation, fault, power off
};

/// Refusals say why, as the dashboard's log would.
using SafetyAnswer = tl::expected<void, std::string>;

/// Robot mode and safety mode, and the limits that lead to a protective stop. One step each cycle, after Arm
/// and World. It owns robot_mode, safety_mode, joint_modes, steady and the status bits of the state.
class Safety {
 public:
  Safety(const RobotModel & model, double cycle_time, const SafetyLimits & limits = {},
         const SafetyTimes & times = {});

  /// Dashboard: power on, brake release (powers on first where need be), power off. Repeating what is already
  /// so is granted.
  SafetyAnswer power_on();
  SafetyAnswer brake_release();
  SafetyAnswer power_off();
  /// Skips all delays: powered on, brakes released (as a test or `start_running` wants it).
  void start_running(ControllerState & state);

  /// Protective stop; a second one while stopped is only logged. URScript's protective_stop(), faults of
  /// motions, limits.
  void trip(std::string_view reason);
  void trip(const MotionFault & fault);
  /// Refused until SafetyTimes::unlock_delay is over, or when there is nothing to unlock.
  SafetyAnswer unlock_protective_stop();

  /// Emergency stop button of the robot (or of the system): latches; powers the arm off after the stop; once
  /// released the robot stays in POWER_OFF with safety mode NORMAL.
  void press_emergency_stop(bool system = false);
  SafetyAnswer release_emergency_stop();
  /// Safeguard input: opens (stop, arm stays powered) and closes again.
  void open_safeguard();
  SafetyAnswer reset_safeguard();
  /// Reduced mode on or off (only between NORMAL and REDUCED).
  SafetyAnswer set_reduced(bool reduced);

  /// Violation and fault power the arm off; only restart_safety() leads out of them.
  void violate(std::string_view reason);
  void fail(std::string_view reason);
  SafetyAnswer restart_safety();

  void set_limits(const SafetyLimits & limits) { limits_ = limits; }
  const SafetyLimits & limits() const { return limits_; }

  /// Advances modes, watches limits, writes the state's modes and bits and says what the controller must do.
  SafetyOrders step(ControllerState & state);

  /// Oldest first; at most 256 are kept, older ones are dropped (and counted).
  std::optional<SafetyEvent> take_event();
  std::uint64_t dropped_events() const { return dropped_; }

 private:
  enum class Power { off, idle, running };  ///< what was asked for

  void log(SafetyEvent::Level level, std::string message);
  void enter(RobotMode mode);
  void enter(SafetyMode mode);
  void stop(SafetyMode mode, SafetyEvent::Level level, std::string message);
  void stop_and_cut_power(SafetyMode mode, std::string message);
  SafetyAnswer may_power_on() const;
  void advance_power();
  void advance_power_cut();
  void watch_limits(const ControllerState & state);
  void watch_rest(const ControllerState & state);
  void write(ControllerState & state) const;
  bool stopped() const { return !allows_motion(safety_mode_); }

  double cycle_time_;
  SafetyLimits limits_;
  SafetyTimes times_;
  LimitWatch watch_;

  RobotMode robot_mode_ = RobotMode::power_off;
  SafetyMode safety_mode_ = SafetyMode::normal;
  Power wanted_ = Power::off;
  std::uint64_t cycle_ = 0;
  double now_ = 0.0;
  double mode_since_ = 0.0;  ///< when robot_mode_ was entered
  double stop_since_ = 0.0;  ///< when safety_mode_ was entered
  double restart_until_ = -1.0;
  double still_for_;
  double cut_since_ = 0.0;
  double release_since_ = 0.0;
  bool releasing_ = false;
  bool cutting_power_ = false;
  bool reduced_ = false;
  std::optional<SafetyMode> button_pressed_;
  SafetyOrders orders_;
  std::deque<SafetyEvent> events_;
  std::uint64_t dropped_ = 0;
};

/// robot_status_bits and safety_status_bits of RTDE for the modes given.
/// Source: UR, "Real-Time Data Exchange (RTDE) Guide", output variables of these names.
std::uint32_t robot_status_bits(RobotMode mode, RuntimeState runtime, bool freedrive);
std::uint32_t safety_status_bits(SafetyMode mode);

}  // namespace ur_simulator
