#include <ur_ros_rtde_msgs/action/set_payload.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

class SetPayload : public Command<ur_ros_rtde_msgs::action::SetPayload> {
  void check(const Goal & goal, Check & check) const override
  {
    check_payload(check, goal.mass, goal.center_of_gravity);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    check_result(run.control()->setPayload(goal.mass, to_ur_center_of_gravity(goal.center_of_gravity)),
                 "set the payload");
    const auto is_set = [&] { return has_payload(run.state(), goal.mass, goal.center_of_gravity); };
    return run.expect(is_set, setting_timeout, "the robot still reports another payload");
  }
};

UR_ROS_RTDE_EXPORT(SetPayload, "set_payload")

}  // namespace ur_ros_rtde
