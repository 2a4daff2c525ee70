#pragma once

#include <vector>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tcp_target.hpp"

namespace ur_ros_rtde {

/// A function of ur_rtde that starts a motion: target, speed, acceleration, asynchronous.
using MoveFunction = bool (ur_rtde::RTDEControlInterface::*)(const std::vector<double> &, double, double,
                                                             bool);

/// Moves to the field `pose` of the goal or, if it has none, to the field `joint_positions`.
template <typename A>
class MoveToTarget : public Command<A> {
 public:
  using typename Command<A>::Goal;
  using typename Command<A>::Run;

  MoveToTarget(MoveFunction move, const SpeedLimits & limits) : move_(move), limits_(limits) {}

  void check(const Goal & goal, Check & check) const override
  {
    if constexpr (has_pose) {
      check_tcp_target(check_speed(check.pose("pose", goal.pose), goal, limits_), goal);
    } else {
      check_speed(check.joints("joint_positions", goal.joint_positions), goal, limits_);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if constexpr (has_pose) {
      const auto target = tcp_target(goal, run.state());
      start(target, goal, run);
      return run.until_pose_reached(target);
    } else {
      start(goal.joint_positions, goal, run);
      return run.until_joints_reached(goal.joint_positions);
    }
  }

 private:
  static constexpr bool has_pose = requires(const Goal & goal) { goal.pose; };

  void start(const std::vector<double> & target, const Goal & goal, Run & run) const
  {
    ((*run.control().hold()).*move_)(target, goal.speed, goal.acceleration, true);
  }

  const MoveFunction move_;
  const SpeedLimits limits_;
};

}  // namespace ur_ros_rtde
