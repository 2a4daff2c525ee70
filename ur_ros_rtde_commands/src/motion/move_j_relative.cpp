#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <ur_ros_rtde_msgs/action/move_j_relative.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double turn = 2.0 * std::numbers::pi;  // to each side of zero
constexpr Vector6 longest{2.0 * turn, 2.0 * turn, 2.0 * turn, 2.0 * turn, 2.0 * turn, 2.0 * turn};

/// Finite, and from `start` within the range of the joint.
Check & check_offsets(Check & check, const std::vector<double> & offsets, const Vector6 & start)
{
  for (std::size_t i = 0; i < start.size() && check.ok(); ++i) {
    check.in_range(fmt::format("joint_offsets[{}] ({})", i, joint_names()[i]), offsets[i], -turn - start[i],
                   turn - start[i], "rad");
  }
  return check;
}
}  // namespace

class MoveJRelative : public Command<ur_ros_rtde_msgs::action::MoveJRelative> {
  void check(const Goal & goal, Check & check) const override
  {
    check.each_joint("joint_offsets", goal.joint_offsets, longest, "rad")
        .above_zero("speed", goal.speed, 3.14, "rad/s")
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2");
    if (const auto start = check.start()) {
      check_offsets(check, goal.joint_offsets, start->actual_q);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_q;
    if (Check again; !check_offsets(again, goal.joint_offsets, start).ok()) {
      return *again.error();
    }
    std::vector<double> target(start.begin(), start.end());
    std::transform(start.begin(), start.end(), goal.joint_offsets.begin(), target.begin(), std::plus<>());
    run.control()->moveJ(target, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveJRelative, "move_j_relative")

}  // namespace ur_ros_rtde
