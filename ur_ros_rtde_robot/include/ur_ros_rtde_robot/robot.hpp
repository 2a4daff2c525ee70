#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "ur_ros_rtde_robot/connection/link.hpp"
#include "ur_ros_rtde_robot/connection/locked.hpp"
#include "ur_ros_rtde_robot/connection/log.hpp"
#include "ur_ros_rtde_robot/motion/activity.hpp"
#include "ur_ros_rtde_robot/motion/lease.hpp"
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

// For the driver

/// The reason for holders that are stopped by Robot::stop_motion().
Error stopped_by_the_driver();

// For plugins

/// One robot: its connections, its control program, and who may use it. Connects ur_rtde's four interfaces in
/// the background, in any power-up order, and reconnects them after a reboot, a pulled cable or a stopped
/// program. Provides the functions that commands share: locking, motion tracking, stopping and arbitration.
/// All methods are thread-safe. The destructor stops the current motion, ends the control program and joins
/// all threads.
class Robot {
 public:
  // For the driver

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

  // Status and model

  RobotStatus status() const;
  /// The connection that brings the samples.
  LinkStatus link() const;
  /// Success if the robot accepts motion commands; else cause and message of the status.
  Status ready_to_move() const;
  /// The same; waits for it, at most for `timeout`.
  Status wait_until_ready(std::chrono::milliseconds timeout, std::stop_token stop = {}) const;
  /// Of the controller; none while it is unknown.
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
  /// See RobotOptions::realtime_priority.
  int realtime_priority() const;

  // Leases

  /// Who may use the robot. A claim that moves the arm is granted if the robot is ready, no stop is under
  /// way, nobody guides the arm by hand, and no other holder is in the way.
  Expected<Lease> acquire(Claim claim);
  /// What a claim that preempts waits for.
  struct Waiting {
    std::chrono::milliseconds timeout;
    std::optional<Generation> since = {};       ///< in which the caller was told to claim; default: now
    std::stop_token stop = {};                  ///< ends the wait
    std::function<bool()> may_go_on = nullptr;  ///< asked after each wait; default: it may
    bool for_program = true;                    ///< also for the control program
  };
  /// The same, after preempting the holders that are in the way. Waits for them, for the stop that they lead
  /// to, and for the control program if such a stop has ended it. A safety stop, or an end of the program
  /// that this driver has not brought about, is an error at once: the arm must not move when it is over.
  Expected<Lease> acquire_preempting(const Claim & claim, const Waiting & waiting);
  /// Success if acquire() would grant the claim to a caller that preempts all holders.
  Status may_use(const Claim & claim) const;
  /// The claim of the holder that a claim on `resource` conflicts with.
  std::optional<Claim> holder(Resource resource) const;
  /// The current run of the control program over the current connection.
  Generation generation() const;
  /// Success if `generation` is the current one; otherwise what ended it.
  Status is_current(const Generation & generation) const;
  /// The same, but an end of the program that this driver has brought about is none.
  Status is_continued(const Generation & generation) const;
  /// Success while `generation` is the current one and the robot can move; otherwise the cause.
  Status is_valid(const Generation & generation) const;
  /// The same for the generation in which the holder of `lease` began.
  Status is_valid(const Lease & lease) const;
  /// The same, and no stop has taken the arm out of the hands of the holder.
  Status may_continue(const Lease & lease) const;

  // Interfaces of ur_rtde

  /// ur_rtde's interfaces. Throw RobotError (not_ready, link_lost, protective_stop, …) if the interface is
  /// unavailable. The calls of a holder that may not go on throw RobotError with the reason.
  Locked<ur_rtde::RTDEControlInterface> control(const Lease & lease);
  Locked<ur_rtde::RTDEReceiveInterface> receive() const;
  Locked<ur_rtde::RTDEIOInterface> io() const;
  Locked<ur_rtde::DashboardClient> dashboard() const;
  /// For callers without a lease: functions that start a motion or a mode, or end the program, throw
  /// std::logic_error.
  Locked<ur_rtde::RTDEControlInterface> control_for_queries() const;

  /// Sends a line to the dashboard server and returns its answer without the line end. Uses a separate
  /// connection, since the robot may have closed a persistent one.
  Expected<std::string> query_dashboard(const std::string & line, std::chrono::milliseconds timeout,
                                        const std::stop_token & stop = {}) const;

  // Samples

  /// The newest sample; none before the first.
  std::optional<Sample> latest() const;
  /// See StateReceiver::wait_for_next(). motion_progress() and is_moving() then include this sample.
  bool wait_for_next(Sample & last, std::chrono::milliseconds timeout, std::stop_token stop = {}) const;

  // Motions

  /// Success if a motion can continue now; else the reason why not: a safety stop, a stopped program, a lost
  /// connection. Evaluates the newest package, so it may be ahead of status().
  Status motion_possible() const;

  /// The motion state before a command, for motion_progress().
  MotionMark mark_motion() const;
  /// A move has been sent since the mark. Other commands, and queries, do not count.
  bool has_sent_move(const MotionMark & since) const;
  /// Progress of the motion since `mark`. Commands without an asynchronous operation (speed_l, servo_j) only
  /// change at_rest.
  MotionProgress motion_progress(const MotionMark & mark) const;
  /// A joint moves, or an asynchronous operation is running.
  bool is_moving() const;
  /// What has been started and not ended, moving or not.
  Activities activities() const;
  /// Nothing but `modes` is active, and only a mode may be moving the arm.
  bool is_at_rest_except(Activities modes) const;
  /// Makes the control program stop the arm if it receives no heartbeat for 1/frequency s (Hz,
  /// min_watchdog_frequency to max_watchdog_frequency). A restarted control program uses
  /// RobotOptions::watchdog_frequency again.
  Status set_watchdog(double frequency);

  // Stops

  /// Stops the arm: takes it out of the hands of all holders, who are told `why`,
  /// decelerates, and waits for standstill, determined from the actual joint velocities. If the control
  /// program does not do it, the dashboard server stops the program, then its watchdog. On error, standstill
  /// is not confirmed.
  Expected<StopReport> stop_motion(const StopOptions & options = {},
                                   const Error & why = stopped_by_the_driver());
  /// While the returned object exists, the control program is not started, at most for 1 s: something else is
  /// about to stop the program of the robot.
  [[nodiscard]] std::shared_ptr<void> hold_program();
  /// The same as stop_motion() without waiting. Returns at once; the arm decelerates within 20 ms.
  std::shared_future<Expected<StopReport>> begin_stop(const StopOptions & options, const Error & why);
  /// Tells the holder of `lease` to end because of `why`: stops what it has started, unless it brakes by
  /// itself (Braking) within `braking_timeout`. Returns at once.
  void request_stop(const Lease & lease, const StopOptions & options, const Error & why,
                    std::chrono::milliseconds braking_timeout);
  /// For a holder that ends: stops what it has started, or waits for the stop that has taken the arm out of
  /// its hands.
  Expected<StopReport> end_motion(const Lease & lease, const StopOptions & options);
  /// The same for a holder that goes on afterwards.
  Expected<StopReport> pause_motion(const Lease & lease, const StopOptions & options);
  /// A stop is under way.
  bool is_stopping() const;
  /// Waits until all holders from whom a stop has taken the arm have released their leases. False after
  /// `timeout`.
  bool wait_for_stopped_holders(std::chrono::milliseconds timeout) const;
  /// The outcome of the newest stop, once it has taken the arm out of the hands of the holder of `lease`.
  /// Empty until then; success without a lease.
  std::optional<Status> stopped(const Lease & lease) const;

  /// While it exists, the holder of the lease streams a motion that it can brake by itself. If it is told to
  /// end, it has to begin within 10 ms and to send a setpoint every 25 ms until the arm is at rest.
  class Braking {
   public:
    explicit Braking(const Lease & lease);
    ~Braking();
    Braking(const Braking &) = delete;
    Braking & operator=(const Braking &) = delete;
    /// A setpoint was sent that brakes.
    void sent() const;

   private:
    std::shared_ptr<Permit> permit_;
  };

  // Scripts and extensions

  /// Sends `script` to the controller and waits until it has ended. `script` is a complete program
  /// (`def … end`, or `sec … end` for a secondary one) or a function body, which is wrapped in a function. If
  /// ScriptOptions::stop_reason or the timeout ends the script, it is stopped and the arm decelerates.
  ///
  /// A program replaces the control program (with control_urcap: not_supported) and needs a lease of
  /// Resource::script. While it runs, status() stays ready, control() throws RobotError (busy), and the
  /// controller ends the program if this process sends no heartbeat (RobotOptions::watchdog_frequency). The
  /// control program runs again on return, unless the robot is stopped or the connection is lost.
  ScriptReport run_script(const Lease & lease, const std::string & script,
                          const ScriptOptions & options = {});

  /// Adds extensions to the control program. Set before start(). Returns one message per omitted extension,
  /// with the reason. An extension that the controller rejects later (for example because it lacks a
  /// function) is omitted then, with a log message.
  std::vector<std::string> set_extensions(const std::vector<ScriptExtension> & extensions);
  /// not_supported, with the reason, if the extension was omitted.
  Status has_extension(const std::string & name) const;
  /// Runs an extension and waits for its end. If ExtensionOptions::stop_reason or the timeout ends it, the
  /// arm decelerates. Needs a lease of Resource::motion. If the snippet fails, the error is rejected_by_robot
  /// and names the line.
  Status run_extension(const Lease & lease, const std::string & name, const ExtensionOptions & options = {});
  /// Writes a parameter of an extension: general purpose register 19 to 22, without the offset of the upper
  /// range. Sample::output_int_registers and output_double_registers contain the results.
  Status set_input_register(int index, std::int32_t value);
  Status set_input_register(int index, double value);
  /// Number of the first register in use: 24 in the upper range, else 0.
  int register_offset() const;

 private:
  /// Whether the holder may command the arm, for one call.
  std::function<Expected<std::shared_ptr<void>>()> permission(const Lease & lease) const;

  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ur_ros_rtde
