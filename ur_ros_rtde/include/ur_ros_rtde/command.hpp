#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ur_ros_rtde/check.hpp"
#include "ur_ros_rtde/command_traits.hpp"
#include "ur_ros_rtde/detail/called_command.hpp"
#include "ur_ros_rtde/detail/command_goal.hpp"
#include "ur_ros_rtde/detail/goal_in_base.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"
#include "ur_ros_rtde/plugin.hpp"
#include "ur_ros_rtde/run.hpp"

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
/// moves the arm at a time. Each goal runs in a thread of its own. When run() returns or throws, what it has
/// started is stopped by decelerating, and the goal gets its only result. When a goal has to end earlier, the
/// arm is stopped without waiting for run(). The result of `A` begins with `bool success, uint16 error_code,
/// string message`. The fields `ArmState final_state` of the result and `MotionFeedback motion` of the
/// feedback are filled in if `A` has them. If the goal of `A` has a field `string frame_id`, its poses are
/// given in that frame of TF (empty: `base`), and check() and run() get them in `base`: the fields `pose`,
/// `via` and `poses`, and those of its `waypoints`.
template <typename A>
class Command : public CommandPlugin {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Run = GoalRun<A>;

  ~Command() override { stop_server(); }

  // To override

  /// How goals share the robot with the goals of other commands. Asked once.
  virtual CommandTraits traits() const { return {}; }
  /// Checks the fields of the goal, then what depends on the robot. Runs in the thread that serves the
  /// requests of all commands, and must not wait; with a `frame_id`, in a thread of the goal, beside others.
  virtual void check(const Goal &, Check &) const {}
  /// Executes the goal in a thread of its own.
  virtual Outcome run(const Goal & goal, Run & run) = 0;
  /// How the arm is stopped if it moves when run() ends or has to end; during a call of another command
  /// (Run::call), as that one says. Asked when the goal is accepted, or called.
  virtual StopOptions stop_options(const Goal &) const { return {}; }
  /// Writes the outcome into the result. Override it for results that begin with other fields. Also asked
  /// when the command is loaded, for goals that it never gets.
  virtual void fill_result(const Outcome & outcome, Result & result) const
  {
    write_standard_fields(outcome, result);
  }

  // For the driver

  void start_action_server(CommandHost & host, const std::string & name) override;
  void stop_action_server() override { stop_server(); }
  /// A goal of this command as a part of another one's, whose message and result outlive it.
  CalledCommand called(const Goal & goal, Result & result);

 private:
  class GoalOfCommand;
  void stop_server();

  std::shared_ptr<const CommandDescription> description_;
  std::unique_ptr<GoalServer> server_;
};

/// A goal of this command, with its types.
template <typename A>
class Command<A>::GoalOfCommand final : public CommandGoal {
 public:
  using Message = typename A::Goal;

  GoalOfCommand(Command & command, const rcl_cxx::GoalUUID & id, const Message & message)
      : CommandGoal(command.description_, id), command_(command), message_(message), goal_(message)
  {
  }

 private:
  bool has_frame(const std::string & base) const override { return goal_.has_frame(base); }
  Status resolve(Frames & frames, const std::stop_token & stop) override
  {
    return goal_.resolve(frames, stop);
  }
  void check_fields(Check & check) const override { command_.check(*goal_, check); }
  StopOptions stop_options() const override { return command_.stop_options(*goal_); }
  std::optional<bool> outlives_client() const override
  {
    if constexpr (requires { message_.outlives_client; }) {
      return message_.outlives_client;
    }
    return std::nullopt;
  }
  Outcome run_command(const RunContext & context) override
  {
    run_.emplace(context);
    return run_->with_warnings(command_.run(*goal_, *run_));
  }
  void send_result(const Outcome & outcome, bool abandoned) override
  {
    Result unused;
    Result & result = abandoned || !run_ ? unused : run_->result();
    if constexpr (requires { result.final_state; }) {
      result.final_state = to_arm_state(robot().latest());
    }
    const Outcome actual = write_outcome(command_, outcome, result);
    send(actual, &result);
  }

  Command & command_;
  const Message & message_;
  GoalInBase<Message> goal_;
  std::optional<Run> run_;
};

template <typename A>
void Command<A>::start_action_server(CommandHost & host, const std::string & name)
{
  description_ = std::make_shared<const CommandDescription>(CommandDescription{
      host, name, host.node().resolve_service_name(name), traits(), script_extension().has_value()});
  GoalServer::Description server{rcl_cxx::action_type<A>(), name, {}, description_->is_stop()};
  if (description_->stops_when_client_lost()) {
    server.on_client_lost = [&host](const rcl_cxx::GoalUUID & id) { host.end_modes_of(id); };
  }
  server_ = std::make_unique<GoalServer>(
      host, server,
      [this](const rcl_cxx::GoalUUID & id, const void * message) {
        return std::make_shared<GoalOfCommand>(*this, id, *static_cast<const Goal *>(message));
      },
      make_missing_results(*this));
  host.add_command(name, *this);
}

template <typename A>
void Command<A>::stop_server()
{
  if (description_) {
    description_->host.remove_command(description_->plugin);
  }
  server_.reset();
}

template <typename A>
CalledCommand Command<A>::called(const Goal & goal, Result & result)
{
  const auto in_base = std::make_shared<GoalInBase<Goal>>(goal);
  return {*description_,
          [this, in_base](const std::stop_token & stop) {
            return in_base->resolve(description_->host.frames(), stop);
          },
          [this, in_base](Check & check) { this->check(**in_base, check); },
          [this, in_base] { return stop_options(**in_base); },
          [this, in_base, &result](const RunContext & context) {
            Run run(context);
            const Outcome outcome = run.with_warnings(this->run(**in_base, run));
            result = std::move(run.result());
            fill_result(outcome, result);
            return outcome;
          }};
}

template <typename A>
Outcome Run::call(const std::string & command, const typename A::Goal & goal, typename A::Result & result)
{
  CommandPlugin * const plugin = find_command(command);
  if (auto why = stop_reason()) {
    return *std::move(why);
  }
  auto * const typed = dynamic_cast<Command<A> *>(plugin);
  if (typed == nullptr) {
    return not_callable(command, plugin != nullptr);
  }
  const Outcome outcome = execute(typed->called(goal, result));
  if constexpr (requires { result.final_state; }) {
    result.final_state = arm_state();
  }
  return outcome;
}

}  // namespace ur_ros_rtde
