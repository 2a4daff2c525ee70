#include <ur_ros_rtde_msgs/action/set_tcp.hpp>

#include "ur_ros_rtde/command.hpp"
#include "ur_ros_rtde/tool_settings.hpp"
#include "ur_ros_rtde_robot/state/conversions.hpp"

namespace ur_ros_rtde {

class SetTcp : public Command<ur_ros_rtde_msgs::action::SetTcp> {
  CommandTraits traits() const override { return {.excludes_force_mode = true}; }

  void check(const Goal & goal, Check & check) const override
  {
    const auto & p = goal.pose.position;
    check.in_range("pose.position.x", p.x, -10.0, 10.0, "m")
        .in_range("pose.position.y", p.y, -10.0, 10.0, "m")
        .in_range("pose.position.z", p.z, -10.0, 10.0, "m")
        .frame("pose", goal.pose)
        .polyscope(0, 6);
  }

  Outcome run(const Goal & goal, Run & run) override { return set_tcp(run, to_ur(goal.pose)); }
};

UR_ROS_RTDE_EXPORT(SetTcp, "set_tcp")

}  // namespace ur_ros_rtde
