#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>

#include "ur_ros_rtde/command_traits.hpp"
#include "ur_ros_rtde/detail/command_executor.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

/// Base class of a robot command, which is an action of type `A`. A command implements what its goal may be
/// (check) and what to do (run):
///
///     class MoveL : public Command<ur_ros_rtde_msgs::action::MoveL> {
///       void check(const Goal & goal, Check & check) const override
///       {
///         check.pose("pose", goal.pose).above_zero("speed", goal.speed, 3.0, "m/s").reachable("pose",
///         goal.pose);
///       }
///       Outcome run(const Goal & goal, Run & run) override
///       {
///         run.control()->moveL(to_ur(goal.pose), goal.speed, goal.acceleration, true);
///         return run.until_pose_reached(to_ur(goal.pose));
///       }
///     };
///     UR_ROS_RTDE_EXPORT(MoveL, "move_l")
///
/// The base class does the rest. A goal is rejected with a reason before it is accepted. Only one command
/// moves the arm at a time. Each goal runs in a thread of its own. When run() returns or throws, the arm is
/// brought to a standstill by decelerating, and the goal gets its only result. The result of `A` begins with
/// `bool success, uint16 error_code, string message`. The fields `ArmState final_state` of the result and
/// `MotionFeedback motion` of the feedback are filled in if `A` has them.
template <typename A>
class Command : public CommandPlugin, private GoalServer<A> {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Run = GoalRun<A>;

  ~Command() override { this->stop_server(); }

  /// Checks the fields of the goal, then what depends on the robot. Runs in the executor's thread and must
  /// not wait.
  virtual void check(const Goal &, Check &) const {}
  /// Executes the goal in a thread of its own.
  virtual Outcome run(const Goal & goal, Run & run) = 0;
  /// How goals share the robot with the goals of other commands. Asked once.
  virtual CommandTraits traits() const { return {}; }
  /// How the arm is stopped if it moves when run() ends or has to end.
  virtual StopOptions stop_options(const Goal &) const { return {}; }

  void start_action_server(CommandHost & host, const std::string & name) override;
  void stop_action_server() override { this->stop_server(); }

 private:
  using Handle = rcl_cxx::ServerGoalHandle<A>;
  rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const Goal & goal) override;
  void execute_goal(Handle & handle, GoalContext & context) override;
  void abort_unstarted(Handle & handle, const Outcome & outcome) override;
  void send_result(Handle & handle, Run & run, const Outcome & outcome);

  std::string name_;
  std::unique_ptr<CommandExecutor> executor_;
};

template <typename A>
void Command<A>::start_action_server(CommandHost & host, const std::string & name)
{
  name_ = name;
  executor_ = std::make_unique<CommandExecutor>(host, host.node().resolve_service_name(name), traits(),
                                                script_extension() ? name : std::string());
  this->start_server(host.node(), name, executor_->goals(), executor_->stops_when_client_lost());
}

template <typename A>
rcl_cxx::GoalDecision Command<A>::accept_goal(const rcl_cxx::GoalUUID & id, const Goal & goal)
{
  return executor_->accept(id, [&](Check & result) { check(goal, result); });
}

template <typename A>
void Command<A>::execute_goal(Handle & handle, GoalContext & context)
{
  Run goal_run(executor_->host().robot(), context.stop_request, executor_->needs_motion(),
               [&handle](const Feedback & feedback) { handle.publish_feedback(feedback); });
  goal_run.on_warning([&](const std::string & text) { executor_->goals().warn(handle.get_goal_id(), text); });
  const auto stop = [&] { return stop_options(handle.get_goal()); };
  const Outcome outcome = executor_->execute(handle.get_goal_id(), context, stop, [&] {
    goal_run.set_preempted_goal(context.preempted_goal);
    goal_run.set_plugin(name_);
    return run(handle.get_goal(), goal_run);
  });
  send_result(handle, goal_run, goal_run.with_warnings(outcome));
}

template <typename A>
void Command<A>::abort_unstarted(Handle & handle, const Outcome & outcome)
{
  Run run(executor_->host().robot(), std::make_shared<StopRequest>(), false, {});
  send_result(handle, run, outcome);
}

template <typename A>
void Command<A>::send_result(Handle & handle, Run & run, const Outcome & outcome)
{
  if constexpr (requires { run.result().final_state; }) {
    run.result().final_state = run.arm_state();
  }
  this->finish(handle, run.result(), outcome);
}

}  // namespace ur_ros_rtde
