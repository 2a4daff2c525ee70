#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <algorithm>
#include <ur_ros_rtde_msgs/action/execute_cartesian_path.hpp>

#include "streaming/trajectory_command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"
#include "ur_ros_rtde_trajectory/cartesian.hpp"

namespace ur_ros_rtde {
namespace {
using kinematics::Pose;
using trajectory::Joints;

constexpr std::size_t max_poses = 10000;

Vector6 to_array(const std::vector<double> & values)
{
  if (values.size() != 6) {
    throw RobotError({ErrorCode::rejected_by_robot,
                      fmt::format("the robot answered with {} values instead of 6", values.size())});
  }
  Vector6 result;
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

/// The inverse kinematics of the controller, which include the calibration of the arm.
Expected<Joints> query_inverse_kinematics(const Run & run, const Pose & pose, const Joints & guess)
{
  const Vector6 target = kinematics::to_ur(pose);
  const auto control = run.control_for_queries().hold();
  try {
    return to_joints(
        control->getInverseKinematics({target.begin(), target.end()}, {guess.begin(), guess.end()}));
  } catch (const std::runtime_error &) {  // no answer
    if (const auto why = run.stop_reason()) {
      return tl::unexpected(*why);
    }
    return failure(ErrorCode::unreachable,
                   fmt::format("the controller finds no joint positions for ({:.3f}, {:.3f}, {:.3f}) m",
                               target[0], target[1], target[2]));
  }
}
}  // namespace

class ExecuteCartesianPath : public TrajectoryCommand<ur_ros_rtde_msgs::action::ExecuteCartesianPath> {
  void check(const Goal & goal, Check & check) const override
  {
    check_trajectory_goal(check, goal, arm());
    check.above_zero("speed", goal.speed, 3.0, "m/s")
        .above_zero("rotation_speed", goal.rotation_speed, 6.28, "rad/s")
        .in_range("blend_radius", goal.blend_radius, 0.0, 1.0, "m")
        .that(!goal.poses.empty() && goal.poses.size() <= max_poses,
              fmt::format("poses has {} entries, it must have 1 to {}", goal.poses.size(), max_poses));
    for (std::size_t i = 0; i < goal.poses.size() && check.ok(); ++i) {
      check.pose(fmt::format("poses[{}]", i), goal.poses[i]);
    }
    check.polyscope(0, 6);  // tells the active TCP
    if (check.ok()) {
      check.reachable(fmt::format("poses[{}]", goal.poses.size() - 1), goal.poses.back());
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Pose tool = kinematics::to_pose(to_array(run.control()->getTCPOffset()));
    std::vector<Pose> poses{kinematics::to_pose(run.state().target_tcp_pose)};
    for (const auto & pose : goal.poses) {
      poses.push_back(kinematics::to_pose(to_array(to_ur(pose))));
    }
    warn_of_identity_orientation(run, path_poses("poses", goal.poses));
    Execution execution = make_execution(goal, run);
    execution.plan = [&](const Joints & start, const std::stop_token & stop) {
      const trajectory::Limits limits = limits_of(goal);
      const auto reference = [&run](const Pose & pose, const Joints & guess) {
        return query_inverse_kinematics(run, pose, guess);
      };
      const auto arm = kinematics::identify_arm(start, poses.front(), tool, run.robot().calibration());
      if (!arm) {
        return Expected<PlannedTrajectory>(tl::unexpected(arm.error()));
      }
      return Expected<PlannedTrajectory>(
          kinematics::plan_cartesian(poses, *arm, start, limits,
                                     {goal.speed, goal.rotation_speed, goal.blend_radius}, reference, stop)
              .map([&](trajectory::Trajectory plan) { return PlannedTrajectory{std::move(plan), limits}; }));
    };
    return finish(execute(run, execution), run);
  }
};

UR_ROS_RTDE_EXPORT(ExecuteCartesianPath, "execute_cartesian_path")

}  // namespace ur_ros_rtde
