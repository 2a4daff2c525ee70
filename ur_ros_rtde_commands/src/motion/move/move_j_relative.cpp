#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <ur_ros_rtde_msgs/action/move_j_relative.hpp>

#include "motion/speed_limits.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double joint_limit = 2.0 * std::numbers::pi;  // rad, on both sides of zero
constexpr double max_offset = 2.0 * joint_limit;
constexpr Vector6 max_offsets{max_offset, max_offset, max_offset, max_offset, max_offset, max_offset};

/// Checks that the offsets are finite and that each joint, from `start`, stays within its range.
Check & check_offsets(Check & check, const std::vector<double> & offsets, const Vector6 & start)
{
  for (std::size_t i = 0; i < start.size() && check.ok(); ++i) {
    check.in_range(fmt::format("joint_offsets[{}] ({})", i, joint_names()[i]), offsets[i],
                   -joint_limit - start[i], joint_limit - start[i], "rad");
  }
  return check;
}
}  // namespace

class MoveJRelative : public Command<ur_ros_rtde_msgs::action::MoveJRelative> {
  void check(const Goal & goal, Check & check) const override
  {
    check_speed(check.each_joint("joint_offsets", goal.joint_offsets, max_offsets, "rad"), goal,
                joint_speed_limits);
    if (const auto start = check.start()) {
      check_offsets(check, goal.joint_offsets, start->actual_q);
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Vector6 start = run.state().actual_q;
    const auto check_range = [&](Check & check) { check_offsets(check, goal.joint_offsets, start); };
    if (Outcome begins = run.check_again(check_range); !begins) {
      return begins;
    }
    std::vector<double> target(start.begin(), start.end());
    std::transform(start.begin(), start.end(), goal.joint_offsets.begin(), target.begin(), std::plus<>());
    run.control()->moveJ(target, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveJRelative, "move_j_relative")

}  // namespace ur_ros_rtde
