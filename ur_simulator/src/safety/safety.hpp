#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "kinematics/robot_model.hpp"
#include "safety/limit_monitor.hpp"
#include "safety/safety_event.hpp"
#include "safety/safety_limits.hpp"
#include "state/controller_state.hpp"
#include "state/faults.hpp"

namespace ur_simulator {

/// Actions that the safety system requests from the rest of the controller in this cycle.
struct SafetyActions {
  std::optional<double> stop_arm;  ///< Arm::stop_all() with this deceleration, rad/s^2
  bool pause_program = false;      ///< a protective, safeguard or emergency stop began
  bool resume_program = false;     ///< the safeguard stop that paused it has ended
  bool stop_program = false;       ///< violation, fault, power off
};

/// The error says why the request is rejected, worded as for the robot's log.
using SafetyResult = tl::expected<void, std::string>;

/// What is wired to the safety system, which a reboot does not change.
struct SafetyInputs {
  std::optional<SafetyMode> emergency_stop;  ///< the mode of the button that is pressed
  bool safeguard_open = false;
  bool reduced = false;
};

/// Whether a protective stop can be unlocked only after SafetyTimes::unlock_delay.
enum class UnlockDelay { required, waived };

/// The safety system: robot mode, safety mode, and the limits whose violation triggers a protective stop.
/// Call step() once per cycle after Arm and World. It owns robot_mode, safety_mode, joint_modes, steady and
/// the status bits of the state.
class Safety {
 public:
  Safety(const RobotModel & model, double cycle_time, const SafetyLimits & limits = {},
         const SafetyTimes & times = {}, const SafetyInputs & inputs = {});

  /// Dashboard commands power on, brake release (powers on first if necessary) and power off. A request that
  /// is already fulfilled succeeds. While the safety system restarts, requests wait until it has restarted.
  SafetyResult power_on();
  SafetyResult brake_release();
  SafetyResult power_off();
  /// Powers on and releases the brakes without delays.
  SafetyResult start_running(ControllerState & state);

  /// Triggers a protective stop; while stopped, the request is only logged.
  void trigger_protective_stop(std::string_view reason,
                               const ErrorCode & code = error_codes::unnumbered_protective_stop);
  void trigger_protective_stop(const MotionFault & fault);
  /// Rejected before the required delay has passed, or if there is no protective stop.
  SafetyResult unlock_protective_stop(UnlockDelay delay = UnlockDelay::required);

  /// Emergency stop button of the robot (or of the system). It latches, and the arm is powered off after the
  /// stop. After the release the robot stays in POWER_OFF with safety mode NORMAL.
  void press_emergency_stop(bool system = false);
  SafetyResult release_emergency_stop();
  /// Safeguard input: the arm stays powered. While the input is open, no recovery of another stop lets the
  /// arm move. Closing and resetting it resumes the program that it paused.
  void open_safeguard();
  SafetyResult reset_safeguard();
  /// Switches between safety modes NORMAL and REDUCED.
  SafetyResult set_reduced(bool reduced);

  /// Safety violation and fault: the arm is powered off, and only restart_safety() ends the mode.
  void trigger_violation(std::string_view reason);
  void trigger_fault(std::string_view reason);
  SafetyResult restart_safety();
  bool restarting() const { return restart_ends_at_ >= 0.0; }
  const SafetyInputs & inputs() const { return inputs_; }

  void set_limits(const SafetyLimits & limits) { limits_ = limits; }
  const SafetyLimits & limits() const { return limits_; }

  /// Advances the modes, checks the limits and writes the modes and status bits of the state. Returns the
  /// actions that the controller has to take.
  SafetyActions step(ControllerState & state);

  /// Writes the modes and status bits of the state, as step() does in each cycle.
  void write(ControllerState & state) const;

  /// Returns the oldest event. At most 256 are kept; older ones are dropped and counted.
  std::optional<SafetyEvent> take_event();
  std::uint64_t dropped_events() const { return dropped_events_; }

 private:
  enum class Power { off, idle, running };

  void log(SafetyEvent::Level level, std::string message, const std::optional<ErrorCode> & code = {});
  void add(SafetyEvent event);
  void enter(RobotMode mode);
  void enter(SafetyMode mode);
  void stop(SafetyMode mode, SafetyEvent::Level level, std::string message,
            const std::optional<ErrorCode> & code);
  void stop_and_cut_power(SafetyMode mode, std::string message, const std::optional<ErrorCode> & code);
  SafetyResult check_power_on() const;
  void update_power();
  void update_power_cut();
  void check_limits(const ControllerState & state);
  void update_standstill(const ControllerState & state);
  bool stopped() const { return !allows_motion(safety_mode_); }
  /// The mode in which only the safeguard and the choice of limits matter.
  SafetyMode undisturbed_mode() const;
  /// The mode that the inputs alone determine.
  SafetyMode mode_of_inputs() const { return inputs_.emergency_stop.value_or(undisturbed_mode()); }

  double cycle_time_;
  SafetyLimits limits_;
  SafetyTimes times_;
  LimitMonitor limit_monitor_;

  RobotMode robot_mode_ = RobotMode::power_off;
  SafetyMode safety_mode_ = SafetyMode::normal;
  Power requested_power_ = Power::off;
  std::uint64_t cycle_ = 0;
  double now_ = 0.0;
  double robot_mode_since_ = 0.0;   ///< timestamp at which robot_mode_ was entered
  double safety_mode_since_ = 0.0;  ///< timestamp at which safety_mode_ was entered
  double restart_ends_at_ = -1.0;
  double standstill_time_;
  double power_cut_since_ = 0.0;
  double brake_release_since_ = 0.0;
  bool releasing_brakes_ = false;
  bool power_cut_pending_ = false;
  SafetyInputs inputs_;
  bool program_runs_ = false;
  bool safeguard_paused_program_ = false;
  SafetyActions actions_;
  std::deque<SafetyEvent> events_;
  std::uint64_t dropped_events_ = 0;
};

/// The RTDE outputs robot_status_bits and safety_status_bits (UR, "Real-Time Data Exchange (RTDE) Guide").
std::uint32_t robot_status_bits(RobotMode mode, RuntimeState runtime, bool freedrive);
std::uint32_t safety_status_bits(SafetyMode mode);

}  // namespace ur_simulator
