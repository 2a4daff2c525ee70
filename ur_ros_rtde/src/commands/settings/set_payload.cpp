#include <cmath>
#include <ur_ros_rtde_msgs/action/set_payload.hpp>

#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {
namespace {
constexpr double tolerance = 1e-3;  // kg, m
}

class SetPayload : public Command<ur_ros_rtde_msgs::action::SetPayload> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("mass", goal.mass, 0.0, 50.0, "kg")
        .vector("center_of_gravity", goal.center_of_gravity, 1.0, "m");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto & cog = goal.center_of_gravity;
    // To ur_rtde's control script a centre of exactly zero means: as it was.
    const double z = cog.x == 0.0 && cog.y == 0.0 && cog.z == 0.0 ? 1e-9 : cog.z;
    run.control()->setPayload(goal.mass, {cog.x, cog.y, z});
    const auto is_set = [&] {
      const Sample sample = run.state();
      const Vector3 & set = sample.payload_cog;
      // Controllers before 5.5 do not report it.
      return std::isnan(sample.payload) ||
             (std::abs(sample.payload - goal.mass) < tolerance &&
              std::hypot(set[0] - cog.x, set[1] - cog.y, set[2] - cog.z) < tolerance);
    };
    return run.expect(is_set, std::chrono::seconds(1), "the robot still reports another payload");
  }
};

UR_ROS_RTDE_EXPORT(SetPayload, "set_payload")

}  // namespace ur_ros_rtde
