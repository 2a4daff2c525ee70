#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/execute_parametrized_trajectory.hpp>

#include "streaming/timed_trajectory.hpp"
#include "streaming/trajectory_command.hpp"

namespace ur_ros_rtde {

class ExecuteParametrizedTrajectory
    : public TrajectoryCommand<ur_ros_rtde_msgs::action::ExecuteParametrizedTrajectory> {
  void check(const Goal & goal, Check & check) const override
  {
    check_trajectory_goal(check, goal, arm());
    check.above_zero("start_tolerance", goal.start_tolerance, 3.2, "rad")
        .that(goal.trajectory.points.size() >= 2,
              fmt::format("trajectory.points has {} points, it must have 2 to {}",
                          goal.trajectory.points.size(), trajectory::max_timed_waypoints));
    if (check.ok()) {
      check_timed_trajectory(check, goal.trajectory, goal_limits(goal, trajectory::make_limits(arm())),
                             goal.start_tolerance, host().options().tf_prefix);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    Execution execution = make_execution(goal, run);
    execution.plan = [&](const trajectory::Joints & start, const std::stop_token &) {
      const trajectory::Limits limits = goal_limits(goal, trajectory::make_limits(arm()));
      return plan_timed_trajectory(goal.trajectory, start, limits).map([&](trajectory::Trajectory plan) {
        return PlannedTrajectory{std::move(plan), limits};
      });
    };
    return finish(execute(run, execution), run);
  }
};

UR_ROS_RTDE_EXPORT(ExecuteParametrizedTrajectory, "execute_parametrized_trajectory")

}  // namespace ur_ros_rtde
