#include <my_package/action/my_command.hpp>
#include <ur_ros_rtde/extension.hpp>

namespace my_package {

class MyCommand : public ur_ros_rtde::Extension<action::MyCommand> {
  // Runs on the controller.
  ur_ros_rtde::ScriptExtension script() const override
  {
    return {.snippet = R"(
      q = get_target_joint_positions()
      q[5] = q[5] + $in19f
      movej(q, a=1.0, v=0.5)
      $out19f(q[5])
    )"};
  }

  void check(const Goal & goal, ur_ros_rtde::Check & check) const override
  {
    check.in_range("angle", goal.angle, -1.0, 1.0, "rad");
  }

  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    run.registers().set_double(19, goal.angle);
    auto outcome = run.trigger(10.0);  // s
    run.result().position = run.registers().get_double(19);
    return outcome;
  }
};

UR_ROS_RTDE_EXPORT(MyCommand, "my_command")

}  // namespace my_package
