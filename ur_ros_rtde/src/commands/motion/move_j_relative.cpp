#include <numbers>
#include <ur_ros_rtde_msgs/action/move_j_relative.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double two_turns = 4.0 * std::numbers::pi;  // from one end to the other
constexpr Vector6 longest{two_turns, two_turns, two_turns, two_turns, two_turns, two_turns};

std::vector<double> sum(const Vector6 & start, const std::vector<double> & offsets)
{
  std::vector<double> target(start.begin(), start.end());
  for (std::size_t i = 0; i < target.size(); ++i) {
    target[i] += offsets[i];
  }
  return target;
}
}  // namespace

class MoveJRelative : public Command<ur_ros_rtde_msgs::action::MoveJRelative> {
  void check(const Goal & goal, Check & check) const override
  {
    check.each_joint("joint_offsets", goal.joint_offsets, longest, "rad")
        .above_zero("speed", goal.speed, 3.14, "rad/s")
        .above_zero("acceleration", goal.acceleration, 40.0, "rad/s^2");
    if (const auto start = check.start()) {
      check.joints("with joint_offsets the target", sum(start->actual_q, goal.joint_offsets));
    }
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto target = sum(run.state().actual_q, goal.joint_offsets);
    if (Check again; !again.joints("with joint_offsets the target", target).ok()) {
      return *again.error();
    }
    run.control()->moveJ(target, goal.speed, goal.acceleration, true);
    return run.until_joints_reached(target);
  }
};

UR_ROS_RTDE_EXPORT(MoveJRelative, "move_j_relative")

}  // namespace ur_ros_rtde
