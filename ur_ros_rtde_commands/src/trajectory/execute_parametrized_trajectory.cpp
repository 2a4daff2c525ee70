#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/execute_parametrized_trajectory.hpp>

#include "streaming/trajectory_command.hpp"

namespace ur_ros_rtde {

class ExecuteParametrizedTrajectory
    : public TrajectoryCommand<ur_ros_rtde_msgs::action::ExecuteParametrizedTrajectory> {
  void check(const Goal & goal, Check & check) const override
  {
    check_trajectory_goal(check, goal, arm());
    check.above_zero("start_tolerance", goal.start_tolerance, 3.2, "rad")
        .that(goal.trajectory.points.size() >= 2,
              fmt::format("trajectory.points has {} points, it takes 2 to {}", goal.trajectory.points.size(),
                          trajectory::max_timed_waypoints));
    auto waypoints = timed_waypoints(goal.trajectory);
    require(check, waypoints.map([](const auto &) {}));
    if (!check.ok()) {
      return;
    }
    const trajectory::Joints first = to_joints(waypoints->positions.front());
    const bool begins_there = waypoints->times.front() == 0.0;
    trajectory::begin_at(*waypoints, first);
    require(check, trajectory::check_timed(*waypoints, goal_limits(goal, trajectory::make_limits(arm()))));
    if (const auto sample = check.start(); sample && begins_there) {
      require(check, check_start_position(first, commanded_joints(*sample), goal.start_tolerance));
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    Execution execution = this->execution(goal, run);
    execution.plan = [&](const trajectory::Joints & start, const std::stop_token &) {
      const trajectory::Limits limits = goal_limits(goal, trajectory::make_limits(arm()));
      return timed_waypoints(goal.trajectory)
          .and_then([&](trajectory::TimedWaypoints waypoints) {
            trajectory::begin_at(waypoints, start);
            return trajectory::plan_timed(waypoints, limits);
          })
          .map([&](trajectory::Trajectory plan) { return Planned{std::move(plan), limits}; });
    };
    return finish(execute(run, execution), run);
  }
};

UR_ROS_RTDE_EXPORT(ExecuteParametrizedTrajectory, "execute_parametrized_trajectory")

}  // namespace ur_ros_rtde
