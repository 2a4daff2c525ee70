#include <ur_ros_rtde/extension.hpp>
#include <ur_ros_rtde_gripper_commands/action/sg_grip.hpp>

#include "gripper.hpp"

namespace ur_ros_rtde_gripper_commands {

class SgGrip : public ur_ros_rtde::Extension<action::SgGrip> {
  ur_ros_rtde::ScriptExtension script() const override
  {
    return make_extension(R"(
      sg_grip($in19i, $in20i == 1, 0, True, $in21i == 1)
      $out19f(get_sg_Width())
    )");
  }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override { check_motion(check, goal); }

  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    run.registers().set_int(19, target_in_millimeters(goal));
    run.registers().set_int(20, goal.gentle);
    run.registers().set_int(21, goal.depth_compensation);
    return trigger_and_read_width(run, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(SgGrip, "sg_grip")

}  // namespace ur_ros_rtde_gripper_commands
