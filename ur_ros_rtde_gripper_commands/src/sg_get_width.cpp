#include <ur_ros_rtde/extension.hpp>
#include <ur_ros_rtde_gripper_commands/action/sg_get_width.hpp>

#include "gripper.hpp"

namespace ur_ros_rtde_gripper_commands {

class SgGetWidth : public ur_ros_rtde::Extension<action::SgGetWidth> {
  ur_ros_rtde::ScriptExtension script() const override
  {
    return make_extension("$out19f(get_sg_Width($in19i))");
  }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override
  {
    check_tool_index(check, goal.tool_index);
  }

  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    run.registers().set_int(19, goal.tool_index);
    return trigger_and_read_width(run, 2.0);
  }
};

UR_ROS_RTDE_EXPORT(SgGetWidth, "sg_get_width")

}  // namespace ur_ros_rtde_gripper_commands
