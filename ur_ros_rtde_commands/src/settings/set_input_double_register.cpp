#include <ur_ros_rtde_msgs/action/set_register.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

class SetInputDoubleRegister : public Command<ur_ros_rtde_msgs::action::SetRegister> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("index", goal.index, 19, 22).that(std::isfinite(goal.value), "value is not finite");
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (!run.io()->setInputDoubleRegister(goal.index + run.robot().register_offset(), goal.value)) {
      return send_failure();
    }
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SetInputDoubleRegister, "set_input_double_register")

}  // namespace ur_ros_rtde
