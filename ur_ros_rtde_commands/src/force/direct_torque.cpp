#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ur_ros_rtde_msgs/action/direct_torque.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"
#include "wait_for_duration.hpp"

namespace ur_ros_rtde {
namespace {
double max_joint_speed(const Sample & sample)
{
  double fastest = 0.0;
  for (const double velocity : sample.actual_qd) {
    fastest = std::max(fastest, std::abs(velocity));
  }
  return fastest;
}

void check_joint_speed(const Sample & sample, double limit)
{
  if (const double speed = max_joint_speed(sample); speed > limit) {
    throw RobotError({ErrorCode::safety_violation,
                      fmt::format("a joint turned at {:.2f} rad/s, more than max_joint_speed ({:.2f} rad/s)",
                                  speed, limit)});
  }
}

void check_scale(Check & check, const char * field, const std::array<double, 6> & scale)
{
  for (std::size_t i = 0; i < scale.size(); ++i) {
    check.in_range(fmt::format("{}[{}]", field, i), scale[i], 0.0, 1.0);
  }
}

std::vector<double> to_vector(const std::array<double, 6> & values)
{
  return {values.begin(), values.end()};
}
}  // namespace

class DirectTorque : public Command<ur_ros_rtde_msgs::action::DirectTorque> {
  CommandTraits traits() const override { return {.blocks_queries = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.joint_torques("joint_torques", goal.joint_torques)
        .in_range("duration", goal.duration, 0.01, 60.0, "s")
        .above_zero("max_joint_speed", goal.max_joint_speed, 3.14, "rad/s");
    check_scale(check, "viscous_scale", goal.viscous_scale);
    check_scale(check, "coulomb_scale", goal.coulomb_scale);
    check.polyscope(25);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    // The control program repeats the command in each cycle until the next one.
    check_result(run.control()->directTorque(goal.joint_torques, to_vector(goal.viscous_scale),
                                             to_vector(goal.coulomb_scale)),
                 "apply the torques");
    if (auto stop_reason = wait_for_duration(
            run, goal.duration, [&](const Sample & now) { check_joint_speed(now, goal.max_joint_speed); })) {
      return *stop_reason;
    }
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(DirectTorque, "direct_torque")

}  // namespace ur_ros_rtde
