#include <ur_ros_rtde/extension.hpp>
#include <ur_ros_rtde_gripper_commands/action/sg_release.hpp>

#include "gripper.hpp"

namespace ur_ros_rtde_gripper_commands {

class SgRelease : public ur_ros_rtde::Extension<action::SgRelease> {
  ur_ros_rtde::ScriptExtension script() const override
  {
    return make_extension(R"(
      sg_release($in19i, 0, True, $in20i == 1)
      $out19f(get_sg_Width())
    )");
  }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override { check_motion(check, goal); }

  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    run.registers().set_int(19, target_in_millimeters(goal));
    run.registers().set_int(20, goal.depth_compensation);
    return trigger_and_read_width(run, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(SgRelease, "sg_release")

}  // namespace ur_ros_rtde_gripper_commands
