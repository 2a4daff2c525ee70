#include <ur_ros_rtde_msgs/action/get_register.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

/// `registers`: the member of Sample with the output registers 12 to 19 of one type.
template <auto registers>
class GetOutputRegister : public QueryCommand<ur_ros_rtde_msgs::action::GetRegister> {
  static constexpr int first = Sample::first_output_register;

  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("index", goal.index, first, first + 7);
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().value = (run.state().*registers)[static_cast<std::size_t>(goal.index - first)];
    return Outcome::success();
  }
};

using GetOutputIntRegister = GetOutputRegister<&Sample::output_int_registers>;
using GetOutputDoubleRegister = GetOutputRegister<&Sample::output_double_registers>;

UR_ROS_RTDE_EXPORT(GetOutputIntRegister, "get_output_int_register")
UR_ROS_RTDE_EXPORT(GetOutputDoubleRegister, "get_output_double_register")

}  // namespace ur_ros_rtde
