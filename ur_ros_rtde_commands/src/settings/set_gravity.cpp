#include <ur_ros_rtde_msgs/action/set_gravity.hpp>

#include "settings/setting_helpers.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

class SetGravity : public Command<ur_ros_rtde_msgs::action::SetGravity> {
  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    const auto & d = goal.direction;
    check.in_range("the length of direction", length(d.x, d.y, d.z), 9.0, 11.0, "m/s^2");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto & d = goal.direction;
    check_result(run.control()->setGravity({d.x, d.y, d.z}), "set the gravity");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SetGravity, "set_gravity")

}  // namespace ur_ros_rtde
