#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/motion/arbiter.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_robot/program/extension_options.hpp"
#include "ur_ros_rtde_robot/program/script.hpp"
#include "ur_ros_rtde_robot/program/script_extension.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_rtde {
class DashboardClient;
class RTDEControlInterface;
class RTDEIOInterface;
class RTDEReceiveInterface;
}  // namespace ur_rtde

namespace ur_ros_rtde {

enum class ControlMode {
  upload,         ///< ur_rtde's control script is sent to the controller; needs remote control (e-Series)
  control_urcap,  ///< the External Control URCap fetches it when its program is played on the robot
};

constexpr double min_watchdog_frequency = 1.0;  // Hz
/// A CB3 controller sends a package, and gets a sign of life, every 8 ms: two within 1/50 s.
constexpr double max_watchdog_frequency = 50.0;  // Hz

struct RobotOptions {
  std::string address;
  /// Hz, of the samples; see StateReceiverOptions.
  double frequency = 0.0;
  ControlMode control_mode = ControlMode::upload;
  std::uint16_t urcap_port = 50002;
  /// General purpose registers 24-47 instead of 0-23: beside a fieldbus, which has the lower ones. From
  /// PolyScope 5.23 on without the mass matrix and the Jacobians, which need registers of both ranges.
  bool upper_range_registers = false;
  /// Of the arm, see arm_limits(); empty: as the controller says. One that contradicts the controller keeps
  /// the arm from being moved.
  std::string model;
  std::chrono::milliseconds connect_timeout{500};
  std::chrono::milliseconds retry_interval{250};
  std::chrono::milliseconds silence_limit{100};
  /// The robot program stops the arm when it has had no sign of life from here for 1/watchdog_frequency s.
  /// Hz, min_watchdog_frequency to max_watchdog_frequency; 0: no watchdog.
  double watchdog_frequency = 10.0;
  /// Start the control program again when it was stopped (with control_urcap: by a lost link) and the robot
  /// is ready for it; never what it was doing.
  bool restart_program = true;
  /// SCHED_FIFO, 1 to 99, of what answers each package with a target: the thread that follows the packages,
  /// and those that send streams of targets; 0: none. Said in the log when not allowed.
  int realtime_priority = 0;
};

enum class RobotState {
  disconnected,  ///< no controller at the address
  connecting,    ///< there is one; interfaces and control program are being set up
  ready,         ///< takes motion commands, or runs a script that was sent in their place
  stopped,       ///< connected, but it cannot move: see the cause
};

const char * to_string(RobotState state);

struct RobotStatus {
  RobotState state = RobotState::disconnected;
  ErrorCode cause = ErrorCode::none;
  /// What is the matter and what to do about it; empty when ready.
  std::string message;
};

/// The robot: ur_rtde's four interfaces, connected in the background in any power-up order and again after a
/// reboot, a pulled cable, a stopped program; and what the commands share: lock, motion tracking, stop,
/// arbiter. All methods are thread-safe. Destruction stops a motion under way, ends the control program and
/// joins all threads.
class Robot {
 public:
  /// Throws std::invalid_argument for options out of range; never for the network's sake.
  explicit Robot(RobotOptions options, LogFunction log = {});
  ~Robot();
  Robot(const Robot &) = delete;
  Robot & operator=(const Robot &) = delete;

  /// Each change of status once, in order, on a thread of the robot. Set before start().
  void on_status(std::function<void(const RobotStatus &)> function);
  /// Each package on the receiving thread: be brief. Set before start().
  void on_sample(std::function<void(const Sample &)> function);
  void start();

  RobotStatus status() const;
  /// Refused with the status' cause and message.
  Status ready_to_move() const;
  Status wait_until_ready(std::chrono::milliseconds limit, std::stop_token stop = {}) const;
  std::optional<ControllerVersion> version() const;
  /// Of the arm's model. Before the controller has told which that is, and when it does not: what every model
  /// can do.
  ArmLimits limits() const;
  int realtime_priority() const;

  /// ur_rtde's interfaces. Throw RobotError (not_ready, link_lost, protective_stop, …) when the interface is
  /// not there.
  Locked<ur_rtde::RTDEControlInterface> control() const;
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;
  Locked<ur_rtde::RTDEIOInterface> io() const;
  Locked<ur_rtde::DashboardClient> dashboard() const;

  /// The answer of the dashboard server to one line, without its end. Over a connection of its own: one that
  /// is kept may have been closed by the robot meanwhile.
  Expected<std::string> ask_dashboard(const std::string & line, std::chrono::milliseconds limit,
                                      const std::stop_token & stop = {}) const;

  std::optional<Sample> latest() const;
  bool wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop = {}) const;

  /// What keeps a motion from going on, now: a safety stop, a stopped program, a lost link; success when
  /// nothing does. From the newest package, without waiting for the next change of status().
  Status motion_possible() const;

  /// Taken before a motion command …
  MotionMark mark_motion() const;
  /// … tells afterwards how far it is. For commands without an asynchronous operation (speed_l, servo_j) only
  /// at_rest counts.
  MotionProgress motion_progress(const MotionMark & mark) const;
  /// Any joint moves, or an asynchronous operation is under way.
  bool moving() const;
  /// Freedrive or teach mode is on: somebody may be moving the arm by hand.
  bool guided() const;
  /// From now on the control program stops the arm when it has had no sign of life for 1/frequency s (Hz,
  /// min_watchdog_frequency to max_watchdog_frequency), until it is started again: then the limit is
  /// RobotOptions::watchdog_frequency again.
  Status set_watchdog(double frequency);

  /// Whatever moves: decelerates, waits for standstill by actual joint velocities. If that does not work,
  /// stops the program by way of the dashboard server. An error means that nobody knows whether the arm
  /// stands.
  Expected<StopReport> stop_motion(const StopOptions & options = {});

  /// Sends `script` to the controller and waits for its end, however that comes. `script` is a whole program
  /// (`def … end`, or `sec … end` for a secondary one) or the body of one, which is put into a function of
  /// its own. A script that must end early, or late, is stopped: the arm decelerates.
  ///
  /// A program replaces the control program (with control_urcap: not_supported): hold Resource::script.
  /// Meanwhile status() stays ready, control() throws RobotError (busy), and the controller ends the program
  /// when this process gives no sign of life (RobotOptions::watchdog_frequency). On return the control
  /// program runs again, unless the robot is stopped or the link is lost.
  ScriptReport run_script(const std::string & script, const ScriptOptions & options = {});

  /// What the control program gets in addition. Set before start(). The sentences tell of each that is left
  /// out, and why; one that the controller does not take (a function that it does not have, …) is left out
  /// later, with a message in the log.
  std::vector<std::string> set_extensions(const std::vector<ScriptExtension> & extensions);
  /// not_supported, with the reason, when it was left out.
  Status has_extension(const std::string & name) const;
  /// Runs an extension and waits for its end. One that has to end early is ended: a motion of its
  /// decelerates. Hold Resource::motion. rejected_by_robot names the line of its snippet that failed.
  Status run_extension(const std::string & name, const ExtensionOptions & options = {});
  /// General purpose registers 19 to 22, without the offset of the upper range: an extension's parameters.
  /// Its results: Sample::output_int_registers, output_double_registers.
  Status set_input_register(int index, std::int32_t value);
  Status set_input_register(int index, double value);
  /// What the numbers of registers begin at: 24 in the upper range, else 0.
  int register_offset() const;

  Arbiter & arbiter();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
