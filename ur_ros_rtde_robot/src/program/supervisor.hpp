#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "connection/interface_links.hpp"
#include "program/script_server.hpp"
#include "state/arm_model.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_link.hpp"
#include "ur_ros_rtde_robot/connection/reporter.hpp"
#include "ur_ros_rtde_robot/robot.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// Brings the robot to `ready` whenever that is possible, and says why it is not. Looks at once when
/// something changes, and every retry interval.
class Supervisor {
 public:
  /// `server`: for ControlMode::control_urcap, outlives it.
  Supervisor(const RobotOptions & options, StateReceiver & state, DashboardLink & dashboard, ArmModel & model,
             InterfaceLinks & links, LogFunction log, const ScriptServer * server = nullptr);
  ~Supervisor() { stop(); }

  std::function<void(const RobotStatus &)> status_function;  ///< set before start()
  void start();
  void stop();

  RobotStatus status() const;
  Status wait_until_ready(std::chrono::milliseconds limit, std::stop_token stop) const;
  /// Every sample, on the receiving thread.
  void add(const Sample & sample);
  void look_now();

  /// Ends the control program for another program to run in its place, until take_back(). Refused when it
  /// does not run.
  Status give_way(std::chrono::milliseconds limit);
  /// The other program has ended: starts the control program again, and returns when it runs or cannot.
  /// `replaced`: by a third one, which is left alone.
  Status take_back(std::chrono::milliseconds limit, bool replaced = false);
  bool gave_way() const;

 private:
  /// Whose turn it is to run a program.
  enum class Turn { own, asked_for, others, coming_back };

  void run(const std::stop_token & stop);
  RobotStatus look();
  RobotStatus look_at_program(const Sample & sample);
  /// An interface could not be made.
  RobotStatus not_made(const Error & error);
  /// Another driver, to which the robot belonged when this one tried last, has left a program that runs on.
  std::optional<Error> program_of_another_driver(const Sample & sample);
  RobotStatus start_program();
  RobotStatus look_at_fetched_program(const Sample & sample);
  RobotStatus wait_for_play();
  RobotStatus take_over_fetched_program();
  /// The link was lost, and with it the program.
  void forget_program();
  /// It is the same link as this sample's.
  bool still_linked(const Sample & sample) const;
  RobotStatus look_at_turn(const Sample & sample, const std::optional<Error> & condition);
  /// Who waits for the turn to come back, or to be given, is answered.
  void settle_turn(const RobotStatus & now);
  void begin_look();
  Turn turn() const;
  bool end_own_program(const Sample & sample);
  /// Somebody else's, running or paused, that came after ours: it is left alone.
  std::optional<Error> other_program(const Sample & sample);
  Status stop_other_program(const Sample & sample);
  bool wait_for_runtime(RuntimeState runtime, std::chrono::milliseconds limit) const;
  void set(const RobotStatus & status);

  const RobotOptions options_;
  StateReceiver & state_;
  DashboardLink & dashboard_;
  ArmModel & model_;
  InterfaceLinks & links_;
  Reporter report_;

  /// Our control program was seen to run, and not seen to end.
  std::atomic<bool> program_ours_{false};
  /// It has ended since the link was made: a program that plays now is somebody else's.
  bool program_ended_ = false;
  /// Starting it has failed, and no program has been seen to be stopped since: what runs is that one.
  bool start_failed_ = false;
  /// Inputs were in use, and no program has been seen to end since.
  bool was_in_use_ = false;
  std::uint32_t link_ = 0;
  std::optional<std::uint32_t> lost_link_;  ///< Sample::link of the link that was lost last
  const ScriptServer * server_;
  /// Since the last program that was ours, none was seen, or somebody else's: what is on the robot began
  /// after ours.
  std::atomic<bool> begins_afresh_{false};
  bool fetched_ran_ = false;       ///< a fetched program was ours, and what ended it has not been looked at
  bool left_running_ = false;      ///< a lost link has left it to its watchdog
  Turn turn_at_look_ = Turn::own;  ///< what the look under way goes by
  std::uint64_t seen_ = 0;         ///< modes of the sample before, receiving thread only

  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  RobotStatus status_;
  bool look_requested_ = false;
  Turn turn_ = Turn::own;
  bool replaced_ = false;  ///< while coming back
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
