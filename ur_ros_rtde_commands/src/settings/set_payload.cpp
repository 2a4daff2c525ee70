#include <ur_ros_rtde_msgs/action/set_payload.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

class SetPayload : public Command<ur_ros_rtde_msgs::action::SetPayload> {
  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    check_payload(check, goal.mass, goal.center_of_gravity);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    return set_payload(run, goal.mass, to_vector(goal.center_of_gravity));
  }
};

UR_ROS_RTDE_EXPORT(SetPayload, "set_payload")

}  // namespace ur_ros_rtde
