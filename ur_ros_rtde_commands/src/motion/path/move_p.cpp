#include <ur_ros_rtde_msgs/action/move_p.hpp>

#include "motion/path/path.hpp"
#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
Waypoints to_waypoints(const ur_ros_rtde_msgs::action::MoveP::Goal & goal)
{
  Waypoints waypoints(goal.poses.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    waypoints[i].type = waypoints[i].MOVE_P;
    waypoints[i].pose = goal.poses[i];
    waypoints[i].speed = goal.speed;
    waypoints[i].acceleration = goal.acceleration;
    waypoints[i].blend_radius = i + 1 < waypoints.size() ? goal.blend_radius : 0.0;
  }
  return waypoints;
}
}  // namespace

class MoveP : public Command<ur_ros_rtde_msgs::action::MoveP> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_speed(check, goal, linear_speed_limits).in_range("blend_radius", goal.blend_radius, 0.0, 2.0, "m");
    check_path(check, "poses", to_waypoints(goal), "");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    warn_of_identity_orientation(run, path_poses("poses", goal.poses));
    return run_path(run, to_waypoints(goal), [&](std::uint32_t index) { run.feedback().waypoint = index; });
  }
};

UR_ROS_RTDE_EXPORT(MoveP, "move_p")

}  // namespace ur_ros_rtde
