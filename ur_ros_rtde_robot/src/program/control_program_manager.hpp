#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "connection/rtde/rtde_interfaces.hpp"
#include "program/program_state_machine.hpp"
#include "program/script_server.hpp"
#include "state/arm_model.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"
#include "ur_ros_rtde_robot/robot_options.hpp"
#include "ur_ros_rtde_robot/robot_status.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Keeps the control program running and reports why it does not run. Feeds ProgramStateMachine with events
/// and executes its actions on a thread of its own, which works when something changes and at every retry
/// interval. No lock is held during an action. Thread-safe.
class ControlProgramManager {
 public:
  /// `server` serves the program in ControlMode::control_urcap. All references must outlive this object.
  ControlProgramManager(const RobotOptions & options, StateReceiver & receiver,
                        DashboardConnection & dashboard, ArmModel & model, RtdeInterfaces & interfaces,
                        const ScriptServer & server, LogFunction log);
  ~ControlProgramManager() { stop(); }

  /// Called on the manager's thread at each change of status. Set before start().
  std::function<void(const RobotStatus &)> status_function;
  /// Starts the thread, which only detects the model of the arm until claim().
  void start();
  /// Claims the robot: its inputs and its program.
  void claim();
  /// Ends the thread, and yield() and resume() in other threads.
  void stop();

  RobotStatus status() const;
  Status wait_until_ready(std::chrono::milliseconds timeout, std::stop_token stop) const;
  ControlOwner control_owner() const;
  /// A program of this driver, without a connection to it, has not been seen stopped.
  bool has_left_program() const;
  /// A program that runs on the robot is not known to be of this driver.
  bool has_foreign_program() const;
  /// Says so, if another program has replaced the control program.
  std::optional<Error> replacement() const;
  /// Number of times that another program has replaced the control program.
  std::uint32_t replacements() const { return replacements_; }

  /// To be called with each sample on the receiving thread.
  void on_sample(const Sample & sample);
  /// Wakes the thread.
  void wake();

  /// Ends the control program so that a script can run in its place, until resume(). Fails unless the control
  /// program runs.
  Status yield(std::chrono::milliseconds timeout);
  /// Starts the control program again after the script. Returns when it runs or cannot run.
  Status resume(std::chrono::milliseconds timeout);
  /// The same, after a script that another program has replaced. That program is left alone.
  Status resume_after_replacement(std::chrono::milliseconds timeout);
  /// See Robot::hold_program().
  std::shared_ptr<void> hold();

 private:
  /// What the receiving thread has processed last.
  struct Processed {
    std::uint32_t link = 0;
    ProgramState state = ProgramState::disconnected;
    ProgramActivity program = ProgramActivity::stopped;
    bool operator==(const Processed &) const = default;
  };

  using Outcome = std::optional<RobotStatus>;  ///< the status that a failure leads to

  void run();
  void cycle();
  RobotStatus examine_guarded();
  /// Feeds the state machine with what is true now, and executes its actions.
  RobotStatus examine();
  /// One pass; empty if something has changed, so that another pass is needed.
  Outcome examine_once();
  /// The newest sample of the current connection.
  tl::expected<Sample, RobotStatus> follow_link();
  /// Once per connection.
  void detect_model();
  /// The connection to the control program alone, and a program that must not continue.
  Outcome follow_program(bool robot_can_move);
  /// What prevents the control program from running, except the program on the robot; or that it runs.
  Outcome check_robot(const std::optional<Error> & blocker);
  /// Starts or adopts the control program, or explains why not.
  Outcome claim_robot();

  /// The only place where the state changes. Queues the action of the transition. Hold mutex_.
  void process(ProgramEvent event);
  void dispatch(ProgramEvent event);
  /// Executes the queued actions and those that their results lead to.
  Outcome execute_actions();
  std::optional<ProgramAction> next_action();
  Outcome execute(ProgramAction action);
  Outcome start_program();
  void wait_after_failed_start();
  void wait_while_held();
  Outcome stop_program_on_robot();
  Outcome connect_control();
  Outcome adopt_program();
  void suspend_program();
  RobotStatus interface_failed(const Error & error);
  Status end_program();
  /// False if the connection was lost, even if there is a new one.
  bool follows_newest_link() const;
  bool wait_for_program(ProgramActivity program, std::chrono::milliseconds timeout) const;
  bool wait_while_program_plays(std::chrono::milliseconds timeout) const;
  bool wait_for_program(const std::function<bool(ProgramActivity)> & condition,
                        std::chrono::milliseconds timeout) const;

  Status resume_by(ProgramEvent event, std::chrono::milliseconds timeout);
  /// Hold mutex_.
  std::uint64_t request_cycle();
  std::uint64_t begin_cycle();
  void finish_cycle(std::uint64_t requests);
  void set_status(const RobotStatus & status);
  std::pair<ProgramState, ProgramObservation> snapshot() const;

  const RobotOptions options_;
  StateReceiver & receiver_;
  DashboardConnection & dashboard_;
  ArmModel & model_;
  RtdeInterfaces & interfaces_;
  const ScriptServer & server_;
  ChangeLogger logger_;

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  ProgramStateMachine machine_;
  ProgramObservation observation_;
  std::uint32_t link_ = 0;  ///< Sample::link of the samples that count; 0 while disconnected
  std::vector<ProgramAction> actions_;
  RobotStatus status_;
  bool wake_ = false;
  std::uint64_t requests_ = 0;  ///< of yield() and resume()
  std::uint64_t handled_ = 0;   ///< requests that a whole cycle has handled
  int holds_ = 0;               ///< objects of hold() that exist

  std::atomic<ProgramState> state_;  ///< machine_.state(), for the receiving thread
  std::atomic<std::uint32_t> replacements_ = 0;
  std::atomic<bool> was_paused_ = false;  ///< the control program, while it was to yield
  // Receiving thread only.
  Processed processed_;
  std::uint64_t modes_ = 0;
  // The manager's thread only.
  std::chrono::steady_clock::time_point
      next_start_{};  ///< earliest time after a failed start; zero after success

  std::uint32_t model_link_ = 0;  ///< Sample::link of the connection for which the model was detected

  std::atomic<bool> claimed_ = false;
  std::stop_source stop_;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
