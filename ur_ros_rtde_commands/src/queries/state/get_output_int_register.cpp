#include <ur_ros_rtde_msgs/action/get_register.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetOutputIntRegister : public QueryCommand<ur_ros_rtde_msgs::action::GetRegister> {
  void check(const Goal & goal, Check & check) const override { check.in_range("index", goal.index, 12, 19); }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value = run.state().output_int_registers[goal.index - 12U];
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetOutputIntRegister, "get_output_int_register")

}  // namespace ur_ros_rtde
