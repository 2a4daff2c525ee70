#pragma once

#include <algorithm>

#include "streaming/execute.hpp"
#include "streaming/goal_fields.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

/// Base class of the trajectory commands: the limits of the arm, and the fields that their goals, results and
/// feedback have in common.
template <typename A>
class TrajectoryCommand : public Command<A> {
 public:
  using Goal = typename A::Goal;
  using Run = GoalRun<A>;

  void start_action_server(CommandHost & host, const std::string & name) override
  {
    host_ = &host;
    Command<A>::start_action_server(host, name);
  }

 protected:
  CommandHost & host() const { return *host_; }
  ArmLimits arm() const { return host_->limits(); }
  /// The limits of a goal without times. Where it has none, the default speeds apply.
  trajectory::Limits limits_of(const Goal & goal) const
  {
    return goal_limits(goal, trajectory::default_speed_limits(trajectory::make_limits(arm())));
  }

  /// The parameters of the goal. `plan` is left empty.
  Execution make_execution(const Goal & goal, Run & run) const;
  /// Fills in the result and returns the outcome.
  static Outcome finish(const ExecutionResult & executed, Run & run)
  {
    run.result().max_tracking_error = executed.max_tracking_error;
    return executed.outcome;
  }

 private:
  CommandHost * host_ = nullptr;
};

template <typename A>
Execution TrajectoryCommand<A>::make_execution(const Goal & goal, Run & run) const
{
  Execution execution;
  if constexpr (requires { goal.start_tolerance; }) {
    execution.start_tolerance = goal.start_tolerance;
  }
  if constexpr (requires { goal.approach; }) {
    execution.approach = goal.approach;
    execution.speed_fraction = goal.speed_fraction;
  }
  execution.servo = {{goal.lookahead_time, goal.gain}, goal.max_tracking_error};
  execution.on_planned = [&run](const trajectory::Trajectory & plan) {
    run.result().duration = run.feedback().time_left =
        plan.duration();  // that of the approach is not included
  };
  execution.on_setpoint = [&run](const trajectory::Trajectory & plan, const StreamState & state) {
    run.progress(plan.progress(state.time));
    const std::size_t next = plan.waypoint_at(state.time) + 1;
    run.feedback().waypoint = static_cast<std::uint32_t>(std::min(next, plan.waypoint_count() - 1));
    run.feedback().tracking_error = state.tracking_error;
    run.feedback().time_left = plan.duration() - state.time;
    return Status();
  };
  return execution;
}

}  // namespace ur_ros_rtde
