#include <ur_ros_rtde_msgs/action/move_path.hpp>

#include "motion/path/path.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class MovePath : public Command<ur_ros_rtde_msgs::action::MovePath> {
  CommandTraits traits() const override { return {.resource = Resource::script}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_path(check, "waypoints", goal.waypoints);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    warn_of_identity_orientation(run, path_poses(goal.waypoints));
    return run_path(run, goal.waypoints, [&](std::uint32_t index) { run.feedback().waypoint = index; });
  }
};

UR_ROS_RTDE_EXPORT(MovePath, "move_path")

}  // namespace ur_ros_rtde
