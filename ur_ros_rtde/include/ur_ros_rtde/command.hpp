#pragma once

#include <memory>
#include <rcl_cxx/node.hpp>
#include <string>

#include "ur_ros_rtde/detail/command_goals.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/plugin.hpp"

namespace ur_ros_rtde {

/// A robot command as an action of type `A`: what is left to write is what the goal may be, and what to do.
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
/// The base class does the rest: goals are refused with the reason before they are accepted; one command
/// moves the arm at a time; run() has a thread of its own; however it ends (it may throw), the arm is brought
/// to a standstill by decelerating, and then the goal gets its one result. `A`'s result begins `bool success,
/// uint16 error_code, string message`; a field `ArmState final_state` in it and a field `MotionFeedback
/// motion` in the feedback are filled in if there are such.
template <typename A>
class Command : public CommandPlugin, private GoalServer<A> {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Run = GoalRun<A>;

  ~Command() override { this->end_service(); }

  /// What the goal's fields may be; then what needs the robot. Runs in the server's thread: no waiting.
  virtual void check(const Goal &, Check &) const {}
  virtual Outcome run(const Goal & goal, Run & run) = 0;

  /// What nobody else may use meanwhile. `motion`, the default, for whatever moves the arm or must not happen
  /// while it moves; `none` for what may happen at any time.
  virtual Resource resource() const { return Resource::motion; }
  /// Never refused for being busy: who is in the way has to end.
  virtual bool takes_over() const { return false; }
  /// A new goal ends the one of the same action that runs, instead of being refused for it.
  virtual bool replaces_its_own() const { return false; }
  /// Switches a mode of the arm on or off that lasts beyond the goal (freedrive_start): success leaves the
  /// arm as it is, moving or not.
  virtual bool switches_mode() const { return false; }
  /// Accepted, and going on, whatever the robot's state is: only its dashboard server has to be there.
  virtual bool any_state() const { return false; }
  /// How the arm is stopped if run() ends, or has to end, while it moves.
  virtual StopOptions stop_options(const Goal &) const { return {}; }

  void start_action_server(CommandHost & host, const std::string & name) override;
  void stop_action_server() override { this->end_service(); }

 private:
  using Handle = rcl_cxx::GoalHandle<A>;
  tl::expected<void, std::string> admit(const rcl_cxx::GoalId & id, const Goal & goal) override;
  void carry_out(Handle & handle, GoalBook::Ticket & ticket) override;
  void give_up(Handle & handle, const Outcome & outcome) override;
  void conclude(Handle & handle, Run & run, const Outcome & outcome);

  std::string name_;
  std::unique_ptr<CommandGoals> goals_;
};

template <typename A>
void Command<A>::start_action_server(CommandHost & host, const std::string & name)
{
  goals_ = std::make_unique<CommandGoals>(
      host, host.node().resolve_service_name(name),
      CommandTraits{resource(), takes_over(), replaces_its_own(), switches_mode(), any_state(),
                    script_extension() ? name : std::string()});
  name_ = name;
  this->serve(host.node(), name, goals_->book(), goals_->needs_client());
}

template <typename A>
tl::expected<void, std::string> Command<A>::admit(const rcl_cxx::GoalId & id, const Goal & goal)
{
  return goals_->admit(id, [&](Check & result) { check(goal, result); });
}

template <typename A>
void Command<A>::carry_out(Handle & handle, GoalBook::Ticket & ticket)
{
  Run goal_run(goals_->host().robot(), ticket.interrupt, goals_->needs_motion(),
               [&handle](const Feedback & feedback) { handle.publish_feedback(feedback); });
  goal_run.on_warning([&](const std::string & text) { goals_->book().warn(handle.goal_id(), text); });
  const auto stop = [&] { return stop_options(handle.goal()); };
  const Outcome outcome = goals_->carry_out(handle.goal_id(), ticket, stop, [&] {
    goal_run.set_displaced(ticket.displaced);
    goal_run.set_plugin(name_);
    return run(handle.goal(), goal_run);
  });
  conclude(handle, goal_run, goal_run.with_warnings(outcome));
}

template <typename A>
void Command<A>::give_up(Handle & handle, const Outcome & outcome)
{
  Run run(goals_->host().robot(), std::make_shared<Interrupt>(), false, {});
  conclude(handle, run, outcome);
}

template <typename A>
void Command<A>::conclude(Handle & handle, Run & run, const Outcome & outcome)
{
  if constexpr (requires { run.result().final_state; }) {
    run.result().final_state = run.arm_state();
  }
  this->finish(handle, run.result(), outcome);
}

}  // namespace ur_ros_rtde
