#include <ur_ros_rtde_msgs/action/execute_trajectory.hpp>

#include "streaming/trajectory_command.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde {
namespace {
std::vector<std::vector<double>> positions_of(const std::vector<ur_ros_rtde_msgs::msg::JointWaypoint> & list)
{
  std::vector<std::vector<double>> positions;
  positions.reserve(list.size());
  for (const auto & waypoint : list) {
    positions.push_back(waypoint.positions);
  }
  return positions;
}
}  // namespace

class ExecuteTrajectory : public TrajectoryCommand<ur_ros_rtde_msgs::action::ExecuteTrajectory> {
  void check(const Goal & goal, Check & check) const override
  {
    check_trajectory_goal(check, goal, arm());
    check.in_range("speed_fraction", goal.speed_fraction, trajectory::min_goal_speed_fraction, 1.0)
        .in_range("blend_tolerance", goal.blend_tolerance, 0.0, trajectory::max_goal_blend_tolerance, "rad")
        .above_zero("start_tolerance", goal.start_tolerance, 3.2, "rad");
    if (check.ok()) {
      require(check, trajectory::check_path(positions_of(goal.waypoints), limits_of(goal)));
    }
    if (const auto sample = check.start(); sample && !goal.approach) {
      Status near = check_start_position(to_joints(goal.waypoints[0].positions), commanded_joints(*sample),
                                         goal.start_tolerance);
      if (!near) {
        near.error().message += ", or set approach: true";
      }
      require(check, near);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    Execution execution = make_execution(goal, run);
    execution.plan = [&](const trajectory::Joints &, std::stop_token stop) {
      const trajectory::Limits limits = limits_of(goal);
      return trajectory::plan_path(positions_of(goal.waypoints), limits,
                                   {goal.blend_tolerance, 0.35, goal.speed_fraction, std::move(stop)})
          .map([&](trajectory::Trajectory plan) { return PlannedTrajectory{std::move(plan), limits}; });
    };
    return finish(execute(run, execution), run);
  }
};

UR_ROS_RTDE_EXPORT(ExecuteTrajectory, "execute_trajectory")

}  // namespace ur_ros_rtde
