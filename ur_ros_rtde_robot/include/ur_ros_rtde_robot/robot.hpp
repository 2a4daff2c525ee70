#pragma once

#include <chrono>
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
#include "ur_ros_rtde_robot/robot_options.hpp"
#include "ur_ros_rtde_robot/robot_status.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"
#include "ur_ros_rtde_trajectory/arm.hpp"
#include "ur_ros_rtde_trajectory/arm_limits.hpp"
#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_rtde {
class DashboardClient;
class RTDEControlInterface;
class RTDEIOInterface;
class RTDEReceiveInterface;
}  // namespace ur_rtde

namespace ur_ros_rtde {

/// One robot. Connects ur_rtde's four interfaces in the background, in any power-up order, and reconnects
/// them after a reboot, a pulled cable or a stopped program. Provides the functions that commands share:
/// locking, motion tracking, stopping and arbitration. All methods are thread-safe. The destructor stops the
/// current motion, ends the control program and joins all threads.
class Robot {
 public:
  /// Throws std::invalid_argument if an option is out of range. Network problems do not throw.
  explicit Robot(RobotOptions options, LogFunction log = {});
  ~Robot();
  Robot(const Robot &) = delete;
  Robot & operator=(const Robot &) = delete;

  /// Called once per change of status, in order, on a thread of the robot. Set before start().
  void on_status(std::function<void(const RobotStatus &)> function);
  /// Called with each package on the receiving thread; must return quickly. Set before start().
  void on_sample(std::function<void(const Sample &)> function);
  /// Optional first step of start(): receives samples and detects the model, but leaves inputs, program and
  /// status() alone.
  void connect();
  /// Starts the control program as soon as possible.
  void start();

  RobotStatus status() const;
  /// Success if the robot accepts motion commands; else cause and message of the status.
  Status ready_to_move() const;
  Status wait_until_ready(std::chrono::milliseconds limit, std::stop_token stop = {}) const;
  std::optional<ControllerVersion> version() const;
  /// s, of the control cycle. 0.002 while the version is unknown.
  double cycle_time() const;
  /// Limits of the arm's model. While the model is unknown: the limits that all models have in common.
  ArmLimits limits() const;
  /// Name of the arm's model, for example "ur10e": RobotOptions::model, or the detected one. Empty if both
  /// are unknown.
  std::string model() const;
  /// Calibrated kinematics of the arm, as its controller reports them; none while they are unknown.
  std::optional<kinematics::DhRows> calibration() const;
  /// Of the controller: RobotOptions::address.
  const std::string & address() const;
  int realtime_priority() const;

  /// ur_rtde's interfaces. Throw RobotError (not_ready, link_lost, protective_stop, …) if the interface is
  /// unavailable.
  Locked<ur_rtde::RTDEControlInterface> control() const;
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;
  Locked<ur_rtde::RTDEIOInterface> io() const;
  Locked<ur_rtde::DashboardClient> dashboard() const;

  /// Sends a line to the dashboard server and returns its answer without the line end. Uses a separate
  /// connection, since the robot may have closed a persistent one.
  Expected<std::string> query_dashboard(const std::string & line, std::chrono::milliseconds limit,
                                        const std::stop_token & stop = {}) const;

  /// The newest sample; none before the first.
  std::optional<Sample> latest() const;
  /// See StateReceiver::wait_for_next(). motion_progress() and moving() then include this sample.
  bool wait_for_next(Sample & last, std::chrono::milliseconds limit, std::stop_token stop = {}) const;

  /// Success if a motion can continue now; else the reason why not: a safety stop, a stopped program, a lost
  /// connection. Evaluates the newest package, so it may be ahead of status().
  Status motion_possible() const;

  /// The motion state before a command, for motion_progress().
  MotionMark mark_motion() const;
  /// Progress of the motion since `mark`. Commands without an asynchronous operation (speed_l, servo_j) only
  /// change at_rest.
  MotionProgress motion_progress(const MotionMark & mark) const;
  /// True if a joint moves or an asynchronous operation is running.
  bool moving() const;
  /// True in freedrive or teach mode, in which an operator may move the arm by hand.
  bool in_freedrive() const;
  /// Makes the control program stop the arm if it receives no heartbeat for 1/frequency s (Hz,
  /// min_watchdog_frequency to max_watchdog_frequency). A restarted control program uses
  /// RobotOptions::watchdog_frequency again.
  Status set_watchdog(double frequency);

  /// Decelerates any motion and waits for standstill, determined from the actual joint velocities. If that
  /// fails, stops the program through the dashboard server. On error, standstill is not confirmed.
  Expected<StopReport> stop_motion(const StopOptions & options = {});

  /// Sends `script` to the controller and waits until it has ended. `script` is a complete program
  /// (`def … end`, or `sec … end` for a secondary one) or a function body, which is wrapped in a function. If
  /// ScriptOptions::stop_reason or the limit ends the script, it is stopped and the arm decelerates.
  ///
  /// A program replaces the control program (with control_urcap: not_supported); the caller must hold
  /// Resource::script. While it runs, status() stays ready, control() throws RobotError (busy), and the
  /// controller ends the program if this process sends no heartbeat (RobotOptions::watchdog_frequency). The
  /// control program runs again on return, unless the robot is stopped or the connection is lost.
  ScriptReport run_script(const std::string & script, const ScriptOptions & options = {});

  /// Adds extensions to the control program. Set before start(). Returns one message per omitted extension,
  /// with the reason. An extension that the controller rejects later (for example because it lacks a
  /// function) is omitted then, with a log message.
  std::vector<std::string> set_extensions(const std::vector<ScriptExtension> & extensions);
  /// not_supported, with the reason, if the extension was omitted.
  Status has_extension(const std::string & name) const;
  /// Runs an extension and waits for its end. If ExtensionOptions::stop_reason or the limit ends it, its
  /// motion decelerates. The caller must hold Resource::motion. If the snippet fails, the error is
  /// rejected_by_robot and names the line.
  Status run_extension(const std::string & name, const ExtensionOptions & options = {});
  /// Writes a parameter of an extension: general purpose register 19 to 22, without the offset of the upper
  /// range. Sample::output_int_registers and output_double_registers contain the results.
  Status set_input_register(int index, std::int32_t value);
  Status set_input_register(int index, double value);
  /// Number of the first register in use: 24 in the upper range, else 0.
  int register_offset() const;

  Arbiter & arbiter();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
