#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ur_ros_rtde_msgs/action/direct_torque.hpp>

#include "force/compliance.hpp"

namespace ur_ros_rtde {
namespace {
/// Nm, of the joints of the largest arm; what each can, its controller sees to.
constexpr Vector6 highest_torques{738.0, 738.0, 433.0, 107.0, 107.0, 107.0};

double fastest_joint(const Sample & sample)
{
  double fastest = 0.0;
  for (const double velocity : sample.actual_qd) {
    fastest = std::max(fastest, std::abs(velocity));
  }
  return fastest;
}

void must_be_slow(const Sample & sample, double limit)
{
  if (const double speed = fastest_joint(sample); speed > limit) {
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
  void check(const Goal & goal, Check & check) const override
  {
    check.each_joint("joint_torques", goal.joint_torques, highest_torques, "Nm")
        .in_range("duration", goal.duration, 0.01, 60.0, "s")
        .above_zero("max_joint_speed", goal.max_joint_speed, 3.14, "rad/s");
    check_scale(check, "viscous_scale", goal.viscous_scale);
    check_scale(check, "coulomb_scale", goal.coulomb_scale);
    check.polyscope(25);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    // The control program repeats it each cycle until the next command.
    must_do(run.control()->directTorque(goal.joint_torques, to_vector(goal.viscous_scale),
                                        to_vector(goal.coulomb_scale)),
            "apply the torques");
    if (auto why = until_over(run, goal.duration,
                              [&](const Sample & now) { must_be_slow(now, goal.max_joint_speed); })) {
      return *why;
    }
    const auto stopped = run.robot().stop_motion(stop_options(goal));
    return stopped ? Outcome::success() : Outcome(stopped.error());
  }
};

UR_ROS_RTDE_EXPORT(DirectTorque, "direct_torque")

}  // namespace ur_ros_rtde
