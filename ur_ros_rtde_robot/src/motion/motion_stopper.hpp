#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "connection/rtde/input_registers.hpp"
#include "connection/rtde/rtde_interfaces.hpp"
#include "motion/arbiter.hpp"
#include "motion/motion_tracker.hpp"
#include "motion/started_activities.hpp"
#include "ur_ros_rtde_robot/connection/change_logger.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"
#include "ur_ros_rtde_robot/state/state_receiver.hpp"

namespace ur_ros_rtde {

/// A stop under way. Ready when standstill is proven, or when every means has failed.
using Stopping = std::shared_future<Expected<StopReport>>;

/// Stops the arm, on a thread of its own, so that a stop never waits for what it stops. It revokes the
/// permits of the holders, whose calls are rejected from then on, and takes the means of `means()` in turn
/// until one of them has brought the arm to rest. A request during a stop joins it; the strongest
/// deceleration applies. Thread-safe.
class MotionStopper {
 public:
  using Clock = Permit::Clock;
  /// See ControlProgramManager.
  struct ProgramQueries {
    std::function<bool()> has_left_program, has_foreign_program;
  };

  MotionStopper(const RobotOptions & options, const StateReceiver & state, RtdeInterfaces & interfaces,
                InputRegisters & registers, const MotionTracker & tracker,
                const StartedActivities & activities, const Arbiter & arbiter, ProgramQueries program,
                LogFunction log);
  ~MotionStopper() { close(); }
  MotionStopper(const MotionStopper &) = delete;
  MotionStopper & operator=(const MotionStopper &) = delete;
  /// Ends the thread, after the stop under way. No stop begins afterwards.
  void close();

  /// Begins to stop the arm, and takes it out of the hands of all holders, who are told `why`. Returns at
  /// once.
  Stopping begin(const StopOptions & options, const Error & why);
  /// For a holder that ends: stops what it has started. If a stop has taken the arm out of its hands before,
  /// that one is returned.
  Stopping end(Permit & holder, const StopOptions & options);
  /// For a holder that goes on afterwards: the same, but the arm stays in its hands.
  Stopping pause(const Permit & holder, const StopOptions & options);
  /// For a holder that is told to end because of `why`: begins to stop the arm. A holder that brakes by
  /// itself may do so under supervision: it has to begin at once, and be at rest within `braking_timeout`. If
  /// a stop of the holder is under way already, only the timeout of the options applies to it.
  void request(const std::shared_ptr<Permit> & holder, const StopOptions & options, const Error & why,
               std::chrono::milliseconds braking_timeout);
  bool is_stopping() const;
  /// Of the newest stop. Empty while one is under way, and until the arm was taken out of the hands of
  /// `holder`.
  std::optional<Status> outcome(const Permit & holder) const;
  /// Number of programs that stops have ended.
  std::uint32_t ended_programs() const { return ended_programs_; }
  /// Waits until no stop is under way. False after `deadline` or if `stop` is requested.
  bool wait_until_idle(Clock::time_point deadline, const std::stop_token & stop);

 private:
  /// The stop under way.
  struct Operation {
    StopOptions options;
    /// By a request after it has been looked at what moves: its holder may just have started something.
    bool joined = false;
    std::promise<Expected<StopReport>> promise;
    Stopping stopping = promise.get_future().share();
  };
  /// A holder that brakes by itself.
  struct Supervision {
    std::shared_ptr<Permit> holder;
    StopOptions options;
    Error why;
    Clock::time_point begin_timeout;  ///< by which it has to brake
    Clock::time_point end_limit;      ///< by which it has to be at rest
    bool is_late = false;             ///< at the last check
  };
  /// One way to stop the arm.
  struct Means {
    StopMeans means;
    /// Success if the arm is at rest; otherwise why this does not work.
    Status (MotionStopper::*attempt)(const StopOptions & options);
  };
  static std::span<const Means> means();
  /// s of the controller, from the end of a program, or a safety stop, to the standstill.
  static constexpr double program_stop_timeout = 1.5;
  /// The samples reflect commands with a delay of some cycles.
  static constexpr std::uint64_t sample_delay = 5;
  /// Until its end, no claim is granted.
  class Beginning;

  Stopping begin_operation(const StopOptions & options);
  /// The one that has taken the arm out of the hands of a holder.
  Stopping current();
  /// An operation with at least these decelerations. The mutex must be held.
  void require(const StopOptions & options);
  /// The stop under way, if there is one, has to end within this time too: StopOptions::timeout.
  void shorten(const std::optional<std::chrono::milliseconds> & timeout);
  void serve(const std::stop_token & stop);
  void execute_operation(std::unique_lock<std::mutex> & lock);
  void supervise();

  // What follows runs on the stopper's thread, without the mutex.
  Expected<StopReport> execute_guarded(const StopOptions & options);
  Expected<StopReport> execute(const StopOptions & options);
  Expected<StopReport> execute_once(const StopOptions & options);
  Expected<StopReport> stop_without_rtde() const;
  bool is_done(const StopOptions & options) const;
  /// The arm is at rest by `means`. Ends also what may move it again.
  Expected<StopMeans> settle(StopMeans means, const StopOptions & options);
  /// For an arm at rest: a program of this driver that the robot has paused, or whose connection was lost,
  /// may move it again.
  bool may_go_on(const Sample & sample, Activities started) const;
  /// That plays, and that these options end. Waits for samples that show it if the arm seems to be at rest.
  bool finds_foreign_program(const StopOptions & options) const;
  /// As late samples do not show yet, but the dashboard server.
  bool foreign_program_plays() const;
  /// Through the dashboard server alone: the program may have no watchdog.
  Expected<StopMeans> end_foreign_program(const StopOptions & options);
  /// The arm is at rest by `means` once the program has ended.
  Expected<StopMeans> end_program_that_may_go_on(StopMeans means, const StopOptions & options);
  Status end_program(const StopOptions & options);
  Status stop_script(const MotionTracker::View & before);
  bool script_begins(const MotionTracker::View & before) const;
  Status request_program_stop(bool end_is_seen) const;
  /// After a command that ends it. `program`: MotionTracker::View::program before; `timeout` in s.
  Status wait_for_program_end(std::uint32_t program, double timeout);
  Status end_call_of_revoked_holder();
  Status stop_by_command(const StopOptions & options);
  Status stop_by_dashboard(const StopOptions & options);
  Status stop_by_watchdog(const StopOptions & options);
  /// Hz, of the program that runs, or was running when the link was lost. 0: it has none.
  double watchdog_frequency() const;
  Status stop_motions(Activities started, const StopOptions & options);
  Status end_modes(Activities started);
  Status send_stop(Activities started, const StopOptions & options);
  /// Calls `command` with the control interface, which it takes from a call of another thread.
  Status with_control(double answer_timeout,
                      const std::function<bool(ur_rtde::RTDEControlInterface &)> & command);
  /// The program that runs had started something when this stop looked, and the connection to it is closed:
  /// what it has started is no longer known, and it may move the arm until its end.
  bool has_given_up_program() const;
  double cycle_time() const;  ///< s
  /// Evaluates `condition` with each sample until it is true. False after `timeout` (s of the controller), if
  /// the connection is lost, and if the options of the stop have changed.
  bool wait_for(double timeout, const std::function<bool(const Sample &)> & condition) const;
  bool wait_for_standstill(double timeout, const StopOptions & options) const;
  /// Until the samples show the robot after this call. False also if the receiving thread hangs.
  bool wait_for_present() const;
  /// s, the age of the newest sample if that is late: it shows neither what has just begun nor a standstill.
  /// Otherwise 0.
  double lateness() const;

  const RobotOptions options_;
  const StateReceiver & state_;
  RtdeInterfaces & interfaces_;
  InputRegisters & registers_;
  const MotionTracker & tracker_;
  const StartedActivities & activities_;
  const Arbiter & arbiter_;
  const ProgramQueries program_;
  ChangeLogger logger_;  ///< stopper's thread only

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::unique_ptr<Operation> operation_;
  Stopping last_;
  std::optional<Supervision> supervision_;
  unsigned beginning_ = 0;
  bool closed_ = false;
  std::atomic<std::uint32_t> ended_programs_ = 0;
  std::atomic<bool> options_changed_ = false;  ///< became stronger since the operation is being executed
  bool stops_in_joint_space_ = false;          ///< stopper's thread only
  /// MotionTracker::View::program, of a program that had started something, until a stop has succeeded.
  /// Stopper's thread only.
  std::optional<std::uint32_t> active_program_;
  std::jthread thread_;
};

}  // namespace ur_ros_rtde
