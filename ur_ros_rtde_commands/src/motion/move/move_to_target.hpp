#pragma once

#include <vector>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

/// A function of ur_rtde that starts a motion: target, speed, acceleration, asynchronous.
using MoveFunction = bool (ur_rtde::RTDEControlInterface::*)(const std::vector<double> &, double, double,
                                                             bool);

/// Moves to the field `joint_positions` of the goal.
template <typename A>
class MoveToJoints : public Command<A> {
 public:
  using typename Command<A>::Goal;
  using typename Command<A>::Run;

  MoveToJoints(MoveFunction move, const SpeedLimits & limits) : move_(move), limits_(limits) {}

  void check(const Goal & goal, Check & check) const override
  {
    check_speed(check.joints("joint_positions", goal.joint_positions), goal, limits_);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    ((*run.control().hold()).*move_)(goal.joint_positions, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(goal.joint_positions);
  }

 private:
  const MoveFunction move_;
  const SpeedLimits limits_;
};

/// Moves to the field `pose` of the goal.
template <typename A>
class MoveToPose : public Command<A> {
 public:
  using typename Command<A>::Goal;
  using typename Command<A>::Run;

  MoveToPose(MoveFunction move, const SpeedLimits & limits) : move_(move), limits_(limits) {}

  void check(const Goal & goal, Check & check) const override
  {
    check_tcp_target(check_speed(check.pose("pose", goal.pose), goal, limits_), goal);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = tcp_target(goal, run.state());
    ((*run.control().hold()).*move_)(target, goal.speed, goal.acceleration, true);
    return run.until_pose_reached(target);
  }

 private:
  const MoveFunction move_;
  const SpeedLimits limits_;
};

}  // namespace ur_ros_rtde
