#pragma once

#include <memory>
#include <utility>

#include "ur_ros_rtde/detail/command_base.hpp"

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
class Command : public CommandBase {
 public:
  using Action = A;
  using Goal = typename A::Goal;
  using Result = typename A::Result;
  using Feedback = typename A::Feedback;
  using Run = GoalRun<A>;

  ~Command() override { CommandBase::stop_action_server(); }

  /// Checks the fields of the goal, then what depends on the robot. Runs in the executor's thread and must
  /// not wait.
  virtual void check(const Goal &, Check &) const {}
  /// Executes the goal in a thread of its own.
  virtual Outcome run(const Goal & goal, Run & run) = 0;
  /// How the arm is stopped if it moves when run() ends or has to end.
  virtual StopOptions stop_options(const Goal &) const { return {}; }
  /// Writes the outcome into the result. Override it for results that begin with other fields.
  virtual void fill_result(const Outcome & outcome, Result & result) const
  {
    write_standard_fields(outcome, result);
  }

 private:
  static const Goal & typed(const void * goal) { return *static_cast<const Goal *>(goal); }

  const rcl_cxx::ActionType & action_type() const final { return rcl_cxx::action_type<A>(); }
  void check_goal(const void * goal, Check & result) const final { check(typed(goal), result); }
  StopOptions stop_options_of(const void * goal) const final { return stop_options(typed(goal)); }
  std::unique_ptr<ur_ros_rtde::Run> make_run(Robot & robot, std::shared_ptr<StopRequest> stop_request,
                                             bool moves, PublishFeedback publish) const final
  {
    return std::make_unique<Run>(robot, std::move(stop_request), moves, std::move(publish));
  }
  Outcome run_goal(const void * goal, ur_ros_rtde::Run & goal_run) final
  {
    return run(typed(goal), static_cast<Run &>(goal_run));
  }
  void write_outcome(const Outcome & outcome, void * result) const final
  {
    fill_result(outcome, *static_cast<Result *>(result));
  }
  void write_failure(const Outcome & outcome, void * result) const final
  {
    write_standard_fields(outcome, *static_cast<Result *>(result));
  }
};

}  // namespace ur_ros_rtde
