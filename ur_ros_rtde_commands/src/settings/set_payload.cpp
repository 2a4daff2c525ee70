#include <ur_ros_rtde_msgs/action/set_payload.hpp>

#include "settings/await.hpp"

namespace ur_ros_rtde {

class SetPayload : public Command<ur_ros_rtde_msgs::action::SetPayload> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("mass", goal.mass, 0.0, 50.0, "kg")
        .vector("center_of_gravity", goal.center_of_gravity, 1.0, "m");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    must_do(run.control()->setPayload(goal.mass, center_for_ur(goal.center_of_gravity)), "set the payload");
    const auto is_set = [&] { return payload_is(run.state(), goal.mass, goal.center_of_gravity); };
    return run.expect(is_set, setting_limit, "the robot still reports another payload");
  }
};

UR_ROS_RTDE_EXPORT(SetPayload, "set_payload")

}  // namespace ur_ros_rtde
