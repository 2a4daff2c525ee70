#include <fmt/format.h>

#include <limits>
#include <ur_ros_rtde_msgs/action/set_register.hpp>

#include "settings/setting_helpers.hpp"

namespace ur_ros_rtde {

class SetInputIntRegister : public Command<ur_ros_rtde_msgs::action::SetRegister> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    using Limits = std::numeric_limits<std::int32_t>;
    check.in_range("index", goal.index, 18, 22)
        .in_range("value", goal.value, Limits::min(), Limits::max())
        .that(goal.value == std::trunc(goal.value),
              fmt::format("value is {}, it must be an integer", goal.value));
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    if (!run.io()->setInputIntRegister(goal.index + run.robot().register_offset(),
                                       static_cast<int>(goal.value))) {
      return send_failure();
    }
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SetInputIntRegister, "set_input_int_register")

}  // namespace ur_ros_rtde
