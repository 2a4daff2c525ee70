#include <ur_ros_rtde_msgs/action/move_c.hpp>

#include "motion/path/path.hpp"
#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
Waypoints to_waypoints(const ur_ros_rtde_msgs::action::MoveC::Goal & goal)
{
  Waypoints waypoints(1);
  waypoints[0].type = waypoints[0].MOVE_C;
  waypoints[0].via = goal.via;
  waypoints[0].pose = goal.pose;
  waypoints[0].speed = goal.speed;
  waypoints[0].acceleration = goal.acceleration;
  return waypoints;
}
}  // namespace

class MoveC : public Command<ur_ros_rtde_msgs::action::MoveC> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.position("via", goal.via.position).position("pose", goal.pose.position);
    check_speed(check, goal, linear_speed_limits)
        .in_range("mode", goal.mode, Goal::UNCONSTRAINED, Goal::FIXED);
    if (goal.mode == Goal::UNCONSTRAINED) {
      check.pose("pose", goal.pose).reachable("pose", goal.pose);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (goal.mode == Goal::UNCONSTRAINED) {
      warn_of_identity_orientation(run, {{"pose", goal.pose}});
    }
    return run_path(run, to_waypoints(goal), [](std::uint32_t) {}, goal.mode);
  }
};

UR_ROS_RTDE_EXPORT(MoveC, "move_c")

}  // namespace ur_ros_rtde
