#include <ur_ros_rtde/extension.hpp>
#include <ur_ros_rtde_gripper_commands/action/sg_get_width.hpp>

#include "gripper.hpp"

namespace ur_ros_rtde_gripper_commands {

class SgGetWidth : public ur_ros_rtde::Extension<action::SgGetWidth> {
  ur_ros_rtde::ScriptExtension script() const override { return make_extension("$out19f(get_sg_Width())"); }

  ur_ros_rtde::Outcome run(const Goal &, Run & run) override { return trigger_and_read_width(run, 2.0); }
};

UR_ROS_RTDE_EXPORT(SgGetWidth, "sg_get_width")

}  // namespace ur_ros_rtde_gripper_commands
