#include <numbers>
#include <ur_ros_rtde_msgs/action/move_l_relative.hpp>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {
namespace {
/// The pose `start`, translated and rotated about the TCP in the axes of the base or of the tool.
std::vector<double> relative_target(const Vector6 & start,
                                    const ur_ros_rtde_msgs::action::MoveLRelative::Goal & goal)
{
  const auto & t = goal.translation;
  const auto & r = goal.rotation;
  Vector6 pose = pose_trans(start, {t.x, t.y, t.z, r.x, r.y, r.z});
  if (goal.frame == goal.BASE) {
    pose = pose_trans({0.0, 0.0, 0.0, r.x, r.y, r.z}, {0.0, 0.0, 0.0, start[3], start[4], start[5]});
    pose[0] = start[0] + t.x;
    pose[1] = start[1] + t.y;
    pose[2] = start[2] + t.z;
  }
  return {pose.begin(), pose.end()};
}

}  // namespace

class MoveLRelative : public Command<ur_ros_rtde_msgs::action::MoveLRelative> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("frame", goal.frame, Goal::BASE, Goal::TOOL)
        .vector("translation", goal.translation, 3.0, "m")
        .vector("rotation", goal.rotation, std::numbers::pi, "rad")
        .in_range("the length of rotation", length(goal.rotation.x, goal.rotation.y, goal.rotation.z), 0.0,
                  std::numbers::pi, "rad");
    check_speed(check, goal, linear_speed_limits);
    if (const auto start = check.start()) {
      check.reachable("the target of translation and rotation",
                      relative_target(start->actual_tcp_pose, goal));
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = relative_target(run.state().actual_tcp_pose, goal);
    run.control()->moveL(target, goal.speed, goal.acceleration, true);
    return run.until_pose_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveLRelative, "move_l_relative")

}  // namespace ur_ros_rtde
