#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/msg/arm_state.hpp>
#include <ur_ros_rtde_msgs/msg/motion_feedback.hpp>
#include <utility>
#include <vector>

#include "ur_ros_rtde/detail/run_context.hpp"
#include "ur_ros_rtde/frames.hpp"
#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde/registers.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

struct CalledCommand;
class Check;
class CommandPlugin;

/// Gives a command access to the robot while it executes a goal, in the goal's thread.
///
/// Waits return early, with the reason, when the goal has to end: it was canceled or preempted, or the node
/// is shut down; for a command that moves the arm, even when the robot has stopped, its control program was
/// started anew, or the connection was lost. By then, the driver is stopping the arm already: return the
/// reason. From then on, calls through control() are rejected. Feedback is published during the waits.
class Run {
 public:
  // For the driver

  explicit Run(RunContext context);
  virtual ~Run() = default;
  Run(const Run &) = delete;
  Run & operator=(const Run &) = delete;

  // Interfaces of ur_rtde

  /// The interfaces of ur_rtde, shared by all commands. `->` locks the interface for one call. The functions
  /// throw RobotError if the interface is not connected, or the goal must no longer move the arm; an
  /// exception that a command does not catch becomes the outcome of its goal. Call only what returns soon:
  /// start motions asynchronously. A command without a lease of the arm, because of its
  /// resource or because it stops the arm, gets control_for_queries().
  Locked<ur_rtde::RTDEControlInterface> control();
  Locked<ur_rtde::RTDEReceiveInterface> receive() const { return context_.robot.receive(); }
  /// This one and dashboard() also work after a stop was requested, to clean up, until the result was sent.
  Locked<ur_rtde::RTDEIOInterface> io() const;
  Locked<ur_rtde::DashboardClient> dashboard() const;
  /// From any thread. Functions that start a motion or a mode, or end the control program, throw.
  Locked<ur_rtde::RTDEControlInterface> control_for_queries() const
  {
    return context_.robot.control_for_queries();
  }

  // State of the robot

  /// The newest sample. Throws RobotError (link_lost) before the first.
  Sample state() const;
  /// For results; NaN before the first sample.
  ur_ros_rtde_msgs::msg::ArmState arm_state() const;
  /// The force (N) and torque (Nm) that the environment exerts on the tool, at the TCP and in the orientation
  /// of the TCP. If the TCP offset has no rotation, which is common, that is the orientation of the flange,
  /// and [2] is the force along the flange's Z axis.
  Vector6 flange_force() const;
  /// The newest pose of a frame of TF in `base`: position (m) and rotation vector (rad). Waits for it, at
  /// most `timeout`: stop a motion before, or use 0. Fails (invalid_goal) with the reason; see
  /// Frames::pose().
  Expected<Vector6> frame(const std::string & frame_id,
                          std::chrono::nanoseconds timeout = Frames::longest_wait) const;
  /// What else is known of the robot: its model and limits, the cycle time, the version.
  const Robot & robot() const { return context_.robot; }

  // Waits

  /// Why the goal has to end now. Empty: it may continue.
  std::optional<StopReason> stop_reason() const;
  /// Empty if the time has passed.
  [[nodiscard]] std::optional<StopReason> sleep_for(std::chrono::nanoseconds duration);
  /// Evaluates `condition` for each sample (every 10 ms without a connection). Empty if it is true; `timeout`
  /// if it was not true in time.
  [[nodiscard]] std::optional<StopReason> until(const std::function<bool()> & condition,
                                                std::chrono::nanoseconds timeout);
  /// Waits for an expected condition. `otherwise` is the failure if it is not true within `timeout`.
  [[nodiscard]] Outcome expect(const std::function<bool()> & condition, std::chrono::nanoseconds timeout,
                               const std::string & otherwise, ErrorCode code = ErrorCode::rejected_by_robot);
  /// Waits for the first sample newer than `sample` and stores it there. For loops at the controller's rate.
  [[nodiscard]] std::optional<StopReason> next(Sample & sample);

  // Motions

  /// Repeats a check of the goal where the motion begins: a goal that was preempted, or force mode, has moved
  /// the arm since it was accepted.
  [[nodiscard]] Outcome check_again(const std::function<void(Check &)> & check);
  /// Waits until the last asynchronous motion that was started through control() has ended and the arm is at
  /// rest. Other calls may have followed it: queries, a mode. Fails if the control program did not start it,
  /// or after `timeout`.
  [[nodiscard]] Outcome until_motion_ends(std::chrono::nanoseconds timeout = std::chrono::minutes(10));
  /// The same with progress, for a known target: fails (not_reached) if the motion ended elsewhere, and
  /// (timeout) if the arm does not come closer to it for 10 min, without the time in which the speed
  /// slider is at 0. Joint positions in rad; a UR pose: position (m) and rotation vector (rad). In force
  /// mode, which moves the arm as well, the end of the motion is sufficient, at rest or not, here and below.
  [[nodiscard]] Outcome until_joints_reached(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_pose_reached(const std::vector<double> & pose);
  /// Waits until the arm is at rest at the target, with progress. For motions whose end the controller does
  /// not report: servo control, scripts. Fails (not_reached) when the arm has been at rest elsewhere, and has
  /// not come closer, for 2 s.
  [[nodiscard]] Outcome until_at_rest_at_joints(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_at_rest_at_pose(const std::vector<double> & pose);
  /// The same for the position of a pose alone.
  [[nodiscard]] Outcome until_at_rest_at_position(const std::vector<double> & pose);
  /// Whether force mode moves the arm: a motion ends without a standstill, and not at its target.
  bool is_compliant() const;
  /// The last asynchronous motion has ended, or has not started within 1 s.
  bool motion_ended() const;
  /// Waits for standstill, judged by actual joint velocities. Empty at standstill; otherwise `timeout`.
  [[nodiscard]] std::optional<StopReason> until_standstill(
      std::chrono::nanoseconds timeout = std::chrono::seconds(5));
  /// Stops what this goal has started, by decelerating, and waits for standstill. Modes stay on; this goal
  /// goes on. Without options: those of Command::stop_options(). With Resource::mode, it does nothing while
  /// another goal moves the arm.
  [[nodiscard]] Outcome stop_motion(std::optional<StopOptions> options = std::nullopt);

  // Other commands, scripts and extensions

  /// Executes a goal of another command, named as its action ("move_l"), as a part of this one: it is
  /// checked, moves the arm with the right of this goal, and ends when this goal has to end. The feedback is
  /// that of this goal. When it ends, what it has started is stopped as for a goal of its own; this goal goes
  /// on, also after a failure. `result` receives the result. Fails with the reason, which names the command.
  /// In command.hpp.
  template <typename A>
  [[nodiscard]] Outcome call(const std::string & command, const typename A::Goal & goal,
                             typename A::Result & result);
  template <typename A>
  [[nodiscard]] Outcome call(const std::string & command, const typename A::Goal & goal)
  {
    typename A::Result unused;
    return call<A>(command, goal, unused);
  }
  /// Calls Robot::run_script, publishes feedback in the meantime, and stops the script when the goal has to
  /// stop. Requires Resource::script.
  ScriptReport run_script(const std::string & script, ScriptOptions options = {});
  /// For an Extension: the registers that its snippet reads and writes, and a function that runs the snippet
  /// and waits for its end, at most `timeout` s.
  Registers registers() const { return Registers(context_.robot); }
  [[nodiscard]] Outcome trigger(double timeout);

  // Result and feedback

  /// Logs a warning for this goal and appends it to the message of the result.
  void warn(const std::string & text);
  /// `outcome` with the warnings in its message.
  Outcome with_warnings(const Outcome & outcome) const;
  /// Published as feedback, 0 to 1.
  void progress(double fraction) { progress_ = fraction; }
  double progress() const { return progress_; }
  /// Since the start of the goal.
  std::chrono::nanoseconds elapsed() const { return std::chrono::steady_clock::now() - begin_; }
  /// The field `motion` of the feedback; empty before the first sample.
  std::optional<ur_ros_rtde_msgs::msg::MotionFeedback> motion_feedback() const;

  // Stops and other special commands

  /// For commands with CommandTraits::preempts_all: waits until the arm is at rest and the preempted goals
  /// have ended. The stop has begun before run().
  Expected<StopReport> wait_for_stop();
  /// The goal that this one preempted: "/move_j, goal 3f0c12ab". Empty if there was none. For commands with
  /// CommandTraits::preempts_all.
  const std::string & preempted_goal() const { return context_.preempted_goal; }
  /// See Robot::set_watchdog().
  Status set_watchdog(double frequency) { return context_.robot.set_watchdog(frequency); }
  /// For a command without a lease that brings the arm into operation: calls `request`, which sends one
  /// request and waits for the answer, unless the goal has to end or there was a stop; then throws RobotError
  /// with the reason. A command that powers the arm off waits for the call, up to 2.5 s.
  void unless_stopped(const std::function<void()> & request) const;
  /// The result of this goal was sent because run() did not return in time: what it would do may disturb a
  /// later goal. To be asked before requests to devices of the plugin, which io() cannot see.
  bool is_abandoned() const;

  // Streams that brake by themselves

  /// While it exists, the command streams setpoints that it can brake by itself, within its own limits: a
  /// request to end the goal does not stop the arm at once. It has to begin to brake within 10 ms, and report
  /// each setpoint that does with `sent()`; otherwise the driver stops the arm. Throws RobotError without a
  /// lease of the arm.
  using Braking = Robot::Braking;
  Braking brake_by_itself() const;
  /// While it brakes: no stop has taken the arm out of its hands, and the robot can move.
  bool may_brake() const { return context_.lease != nullptr && robot().may_continue(*context_.lease); }

 protected:
  /// Called 20 times per second during waits.
  virtual void publish_feedback() {}
  void publish(const void * feedback) const { context_.publish_feedback(feedback); }

 private:
  friend class TargetStream;
  /// For how long control() waits for the call of another thread: a stream must not outlast its timeout.
  /// Zero: the default of Locked. Otherwise its calls go before those of others. Returns what was set before.
  std::chrono::milliseconds exchange_control_timeout(std::chrono::milliseconds timeout)
  {
    return std::exchange(control_timeout_, timeout);
  }
  /// The last call through control() that has sent a move; if there is none, the beginning of this goal.
  struct Motion {
    MotionMark mark;
    std::chrono::steady_clock::time_point begin;
  };
  const Motion & motion() const { return robot().has_sent_move(call_.mark) ? call_ : motion_; }
  struct Target;
  Outcome until_reached(const Target & target, double tolerance);
  Outcome until_at(const Target & target, double tolerance);
  std::optional<StopReason> wait(const std::function<bool()> & condition,
                                 std::chrono::steady_clock::time_point deadline);
  void publish_feedback_if_due();
  void require_unsent_result() const;
  CommandPlugin * find_command(const std::string & name) const;
  Outcome execute(const CalledCommand & called);
  Status may_execute(const CalledCommand & called) const;
  /// Stops everything but the modes that `options` keeps, and waits for standstill.
  Status stop_except_kept(const StopOptions & options);
  /// Stops what a called command has started and does not leave active.
  Outcome settle(const CalledCommand & called, const Outcome & outcome, Activities active_before);

  const RunContext context_;
  double progress_ = 0.0;
  std::string warnings_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_feedback_ = begin_;
  Motion call_;    ///< the last one through control()
  Motion motion_;  ///< before that call; see motion()
  std::chrono::milliseconds control_timeout_{0};
};

/// Run with the result and the feedback of action `A`.
template <typename A>
class GoalRun : public Run {
 public:
  using Run::Run;

  /// Set the fields that are specific to the action. `success`, `error_code`, `message` and `final_state` are
  /// filled in by the base class.
  typename A::Result & result() { return result_; }
  /// Set the fields that are specific to the action. `motion` is filled in by the base class.
  typename A::Feedback & feedback() { return feedback_; }
  /// Publishes the feedback. Needed only if the feedback has no field `motion`; otherwise it is published
  /// during waits.
  void publish() { Run::publish(&feedback_); }

 private:
  void publish_feedback() override
  {
    if constexpr (requires(typename A::Feedback & feedback) { feedback.motion; }) {
      if (auto motion = motion_feedback()) {
        feedback_.motion = *motion;
        publish();
      }
    }
  }

  typename A::Result result_;
  typename A::Feedback feedback_;
};

/// The state of an arm in results: NaN without a sample.
ur_ros_rtde_msgs::msg::ArmState to_arm_state(const std::optional<Sample> & sample);

}  // namespace ur_ros_rtde
