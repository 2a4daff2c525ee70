#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <ur_ros_rtde_msgs/msg/arm_state.hpp>
#include <ur_ros_rtde_msgs/msg/motion_feedback.hpp>
#include <vector>

#include "ur_ros_rtde/detail/stop_request.hpp"
#include "ur_ros_rtde/outcome.hpp"
#include "ur_ros_rtde/registers.hpp"
#include "ur_ros_rtde_robot/connection/interfaces.hpp"

namespace ur_ros_rtde {

/// What a command has in hand while it carries out a goal, in the goal's own thread.
///
/// The waits return early, with the reason, when the goal is to end: canceled, preempted, the node shuts
/// down, and for a command that moves the arm also when the robot stopped or the link is lost. Then return
/// that reason; the arm is stopped by the base class. Feedback is published from within the waits.
class Run {
 public:
  Run(Robot & robot, std::shared_ptr<StopRequest> stop_request, bool moves);
  virtual ~Run() = default;
  Run(const Run &) = delete;
  Run & operator=(const Run &) = delete;

  /// ur_rtde's interfaces, shared by all commands; `->` locks one for that call. Throw RobotError when one is
  /// not connected; what a command does not catch ends its goal with that error. Call only what returns soon:
  /// motions asynchronously.
  Locked<ur_rtde::RTDEControlInterface> control();
  Locked<ur_rtde::RTDEReceiveInterface> receive() const { return robot_.receive(); }
  Locked<ur_rtde::RTDEIOInterface> io() const { return robot_.io(); }
  Locked<ur_rtde::DashboardClient> dashboard() const { return robot_.dashboard(); }
  Robot & robot() const { return robot_; }

  /// The newest package of the controller. Throws RobotError (link_lost) before the first.
  Sample state() const;
  ur_ros_rtde_msgs::msg::ArmState arm_state() const;
  /// What the surroundings exert on the tool: N and Nm at the TCP, in the orientation of the TCP; with the
  /// TCP's offset not rotated, as is usual, that is the orientation of the flange: [2] is the force along the
  /// flange's Z axis.
  Vector6 flange_force() const;

  /// Why the goal has to end now, if it has to.
  std::optional<StopReason> stop_reason() const;
  /// Nothing if the time has passed.
  [[nodiscard]] std::optional<StopReason> sleep_for(std::chrono::nanoseconds duration);
  /// Looks at `condition` with each package of the controller (each 10 ms without link). Nothing if it
  /// holds; timeout.
  [[nodiscard]] std::optional<StopReason> until(const std::function<bool()> & condition,
                                                std::chrono::nanoseconds timeout);

  /// The same for what has to come: `otherwise` is the failure when it has not come within `timeout`.
  [[nodiscard]] Outcome expect(const std::function<bool()> & condition, std::chrono::nanoseconds timeout,
                               const std::string & otherwise, ErrorCode code = ErrorCode::rejected_by_robot);
  /// Waits for the first package of the controller after `sample` and puts it there: for loops that follow
  /// the controller's cycle.
  [[nodiscard]] std::optional<StopReason> next(Sample & sample);

  /// Until the asynchronous move begun by the last call through control() has ended and the arm stands still.
  /// A failure, if the control program did not begin it, or after `limit`.
  [[nodiscard]] Outcome until_motion_ends(std::chrono::nanoseconds limit = std::chrono::minutes(10));
  /// The same, with progress, and a failure (not_reached) if it ended elsewhere. ur_rtde's values: rad; m and
  /// rotation vector.
  [[nodiscard]] Outcome until_joints_reached(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_pose_reached(const std::vector<double> & pose);
  /// Until the arm is there and stands still, with progress, for motions of whose end the controller says
  /// nothing: servo control, scripts. A failure (not_reached) when it has stood still elsewhere for two
  /// seconds.
  [[nodiscard]] Outcome until_at_joints(const std::vector<double> & positions);
  [[nodiscard]] Outcome until_at_pose(const std::vector<double> & pose);
  /// The last asynchronous move has ended, or nothing of it began within a second.
  bool motion_ended() const;
  /// The arm stands still (by its joints' velocities). Nothing if it does; timeout.
  [[nodiscard]] std::optional<StopReason> until_standstill(
      std::chrono::nanoseconds limit = std::chrono::seconds(5));

  /// Robot::run_script, ended early when the goal has to end, with feedback meanwhile. Hold Resource::script.
  ScriptReport run_script(const std::string & script, ScriptOptions options = {});

  /// Of an Extension: the registers that its snippet reads and writes; runs the snippet and waits for its
  /// end, `timeout` s at most.
  Registers registers() const { return Registers(robot_); }
  [[nodiscard]] Outcome trigger(double timeout);

  /// Logs `text` as a warning of this goal; the message of the result says it, too.
  void warn(const std::string & text);
  void on_warning(std::function<void(const std::string &)> log) { log_warning_ = std::move(log); }
  /// `outcome`, with the warnings in its message.
  Outcome with_warnings(const Outcome & outcome) const;

  /// For the feedback; 0 to 1.
  void progress(double fraction) { progress_ = fraction; }
  double progress() const { return progress_; }
  std::chrono::nanoseconds elapsed() const { return std::chrono::steady_clock::now() - begin_; }
  /// Of a command that takes over: which goal had to end, "/move_j, goal 3f0c12ab"; empty if there was none.
  const std::string & preempted_goal() const { return preempted_goal_; }
  void set_preempted_goal(std::string goal) { preempted_goal_ = std::move(goal); }
  void set_plugin(std::string name) { plugin_ = std::move(name); }

  /// For the feedback; nothing while no package has come.
  std::optional<ur_ros_rtde_msgs::msg::MotionFeedback> motion_feedback() const;

 protected:
  /// 20 times a second while the goal waits.
  virtual void publish_feedback() {}

 private:
  using Distance = std::function<double(const Sample &)>;
  Outcome until_reached(const Distance & distance, double tolerance, const char * unit);
  Outcome until_at(const Distance & distance, double tolerance, const char * unit);
  std::optional<StopReason> wait(const std::function<bool()> & condition,
                                 std::chrono::steady_clock::time_point deadline);
  void feed_back();

  Robot & robot_;
  std::shared_ptr<StopRequest> stop_request_;
  bool moves_;
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

/// Run, with the result and the feedback of action `A`.
template <typename A>
class GoalRun : public Run {
 public:
  using Publish = std::function<void(const typename A::Feedback &)>;

  GoalRun(Robot & robot, std::shared_ptr<StopRequest> stop_request, bool moves, Publish publish)
      : Run(robot, std::move(stop_request), moves), publish_(std::move(publish))
  {
  }

  /// For fields of your own; success, error_code, message and final_state are filled in for you.
  typename A::Result & result() { return result_; }
  /// For fields of your own; `motion` is filled in for you.
  typename A::Feedback & feedback() { return feedback_; }
  /// For feedback without a field `motion`, which is not published by itself.
  void publish() { publish_(feedback_); }

 private:
  void publish_feedback() override
  {
    if constexpr (requires(typename A::Feedback & feedback) { feedback.motion; }) {
      if (auto motion = motion_feedback()) {
        feedback_.motion = *motion;
        publish_(feedback_);
      }
    }
  }

  typename A::Result result_;
  typename A::Feedback feedback_;
  Publish publish_;
};

}  // namespace ur_ros_rtde
