#include <fmt/format.h>

#include <ur_ros_rtde_msgs/action/set_target_payload.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double inertia_limit = 133.0;     // kg m^2, limit of the controller
constexpr double inertia_tolerance = 1e-4;  // kg m^2
constexpr std::size_t diagonal = 3;         // Ixx, Iyy, Izz

bool has_inertia(const Sample & sample, const std::array<double, 6> & inertia)
{
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    // Controllers before PolyScope 5.11 report NaN, which does not fail the comparison.
    if (std::abs(sample.payload_inertia[i] - inertia[i]) > inertia_tolerance) {
      return false;
    }
  }
  return true;
}
}  // namespace

class SetTargetPayload : public Command<ur_ros_rtde_msgs::action::SetTargetPayload> {
  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_payload(check, goal.mass, goal.center_of_gravity);
    for (std::size_t i = 0; i < goal.inertia.size(); ++i) {
      const double lowest = i < diagonal ? 0.0 : -inertia_limit;
      check.in_range(fmt::format("inertia[{}]", i), goal.inertia[i], lowest, inertia_limit, "kg m^2");
    }
    check.polyscope(10);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> inertia(goal.inertia.begin(), goal.inertia.end());
    const Vector3 cog = to_vector(goal.center_of_gravity);
    check_result(run.control()->setTargetPayload(goal.mass, to_ur_center_of_gravity(cog), inertia),
                 "set the payload");
    const auto is_set = [&] {
      return has_payload(run.state(), goal.mass, cog) && has_inertia(run.state(), goal.inertia);
    };
    return run.expect(is_set, setting_timeout, "the robot still reports another payload");
  }
};

UR_ROS_RTDE_EXPORT(SetTargetPayload, "set_target_payload")

}  // namespace ur_ros_rtde
