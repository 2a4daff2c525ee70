#include <ur_ros_rtde_msgs/action/get_register.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetOutputDoubleRegister : public QueryCommand<ur_ros_rtde_msgs::action::GetRegister> {
  void check(const Goal & goal, Check & check) const override { check.in_range("index", goal.index, 12, 19); }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value = run.state().output_double_registers[goal.index - 12U];
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetOutputDoubleRegister, "get_output_double_register")

}  // namespace ur_ros_rtde
