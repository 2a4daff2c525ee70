#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/msg/arm_state.hpp>
#include <ur_ros_rtde_msgs/msg/motion_feedback.hpp>
#include <vector>

#include "ur_ros_rtde/detail/publish_feedback.hpp"
#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde/registers.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {

/// Gives a command access to the robot while it executes a goal, in the goal's thread.
///
/// Waits return early, with the reason, when the goal has to stop: it was canceled or preempted, or the node
/// is shut down; for a command that moves the arm, also when the robot has stopped or the connection is lost.
/// A command then returns that reason, and the base class stops the arm. Feedback is published during the
/// waits.
class Run {
 public:
  Run(Robot & robot, std::shared_ptr<StopRequest> stop_request, bool moves);
  virtual ~Run() = default;
  Run(const Run &) = delete;
  Run & operator=(const Run &) = delete;

  /// The interfaces of ur_rtde, shared by all commands. `->` locks the interface for one call. The functions
  /// throw RobotError if the interface is not connected; an exception that a command does not catch becomes
  /// the outcome of its goal. Call only what returns soon: start motions asynchronously.
  Locked<ur_rtde::RTDEControlInterface> control();
  Locked<ur_rtde::RTDEReceiveInterface> receive() const { return robot_.receive(); }
  Locked<ur_rtde::RTDEIOInterface> io() const { return robot_.io(); }
  Locked<ur_rtde::DashboardClient> dashboard() const { return robot_.dashboard(); }
  Robot & robot() const { return robot_; }

  /// The newest sample. Throws RobotError (link_lost) before the first.
  Sample state() const;
  ur_ros_rtde_msgs::msg::ArmState arm_state() const;
  /// The force (N) and torque (Nm) that the environment exerts on the tool, at the TCP and in the orientation
  /// of the TCP. If the TCP offset has no rotation, which is common, that is the orientation of the flange,
  /// and [2] is the force along the flange's Z axis.
  Vector6 flange_force() const;

  /// Why the goal has to stop now. Empty: it may continue.
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

  /// Waits until the asynchronous motion that the last call through control() has started has ended and the
  /// arm stands still. Fails if the control program did not start it, or after `limit`.
  [[nodiscard]] Outcome until_motion_ends(std::chrono::nanoseconds limit = std::chrono::minutes(10));
  /// The same with progress, for a known target: fails (not_reached) if the motion ended elsewhere. Joint
  /// positions in rad; a UR pose: position (m) and rotation vector (rad).
  [[nodiscard]] Outcome until_joints_reached(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_pose_reached(const std::vector<double> & pose);
  /// Waits until the arm stands still at the target, with progress. For motions whose end the controller does
  /// not report: servo control, scripts. Fails (not_reached) when the arm has stood still elsewhere for 2 s.
  [[nodiscard]] Outcome until_at_joints(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_at_pose(const std::vector<double> & pose);
  /// The last asynchronous motion has ended, or has not started within 1 s.
  bool motion_ended() const;
  /// Waits for standstill, judged by actual joint velocities. Empty at standstill; otherwise `timeout`.
  [[nodiscard]] std::optional<StopReason> until_standstill(
      std::chrono::nanoseconds limit = std::chrono::seconds(5));

  /// Calls Robot::run_script, publishes feedback meanwhile, and stops the script when the goal has to stop.
  /// Requires Resource::script.
  ScriptReport run_script(const std::string & script, ScriptOptions options = {});

  /// For an Extension: the registers that its snippet reads and writes, and a function that runs the snippet
  /// and waits for its end, at most `timeout` s.
  Registers registers() const { return Registers(robot_); }
  [[nodiscard]] Outcome trigger(double timeout);

  /// Logs a warning for this goal and appends it to the message of the result.
  void warn(const std::string & text);
  void on_warning(std::function<void(const std::string &)> log) { log_warning_ = std::move(log); }
  /// `outcome` with the warnings in its message.
  Outcome with_warnings(const Outcome & outcome) const;

  /// Published as feedback, 0 to 1.
  void progress(double fraction) { progress_ = fraction; }
  double progress() const { return progress_; }
  std::chrono::nanoseconds elapsed() const { return std::chrono::steady_clock::now() - begin_; }
  /// The goal that this one preempted: "/move_j, goal 3f0c12ab". Empty if there was none. For commands with
  /// CommandTraits::preempts_all.
  const std::string & preempted_goal() const { return preempted_goal_; }
  void set_preempted_goal(std::string goal) { preempted_goal_ = std::move(goal); }
  void set_plugin(std::string name) { plugin_ = std::move(name); }

  /// Empty before the first sample.
  std::optional<ur_ros_rtde_msgs::msg::MotionFeedback> motion_feedback() const;

  /// Fills in `final_state` and returns the result, an A::Result. Null if this is not the run of a goal.
  virtual void * finish_result() { return nullptr; }

 protected:
  /// Called 20 times per second during waits.
  virtual void publish_feedback() {}

 private:
  using Distance = std::function<double(const Sample &)>;
  Outcome until_reached(const Distance & distance, double tolerance, const char * unit);
  Outcome until_at(const Distance & distance, double tolerance, const char * unit);
  std::optional<StopReason> wait(const std::function<bool()> & condition,
                                 std::chrono::steady_clock::time_point deadline);
  void publish_feedback_if_due();

  Robot & robot_;
  std::shared_ptr<StopRequest> stop_request_;
  bool moves_;
  std::uint32_t link_;  ///< Sample::link at the begin
  double progress_ = 0.0;
  std::string preempted_goal_;
  std::string plugin_;
  std::string warnings_;
  std::function<void(const std::string &)> log_warning_ = [](const std::string &) {};
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_feedback_ = begin_;
  std::chrono::steady_clock::time_point last_call_ = begin_;
  MotionMark mark_;
};

/// Run with the result and the feedback of action `A`.
template <typename A>
class GoalRun : public Run {
 public:
  GoalRun(Robot & robot, std::shared_ptr<StopRequest> stop_request, bool moves, PublishFeedback publish)
      : Run(robot, std::move(stop_request), moves), publish_(std::move(publish))
  {
  }

  /// Set the fields that are specific to the action. `success`, `error_code`, `message` and `final_state` are
  /// filled in by the base class.
  typename A::Result & result() { return result_; }
  /// Set the fields that are specific to the action. `motion` is filled in by the base class.
  typename A::Feedback & feedback() { return feedback_; }
  /// Publishes the feedback. Needed only if the feedback has no field `motion`; otherwise it is published
  /// during waits.
  void publish() { publish_(&feedback_); }

  void * finish_result() override
  {
    if constexpr (requires { result_.final_state; }) {
      result_.final_state = arm_state();
    }
    return &result_;
  }

 private:
  void publish_feedback() override
  {
    if constexpr (requires(typename A::Feedback & feedback) { feedback.motion; }) {
      if (auto motion = motion_feedback()) {
        feedback_.motion = *motion;
        publish_(&feedback_);
      }
    }
  }

  typename A::Result result_;
  typename A::Feedback feedback_;
  PublishFeedback publish_;
};

}  // namespace ur_ros_rtde
