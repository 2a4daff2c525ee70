#include <ur_ros_rtde_msgs/action/set_external_force_torque.hpp>

#include "ur_ros_rtde/check_result.hpp"
#include "ur_ros_rtde/command.hpp"

namespace ur_ros_rtde {

class SetExternalForceTorque : public Command<ur_ros_rtde_msgs::action::SetExternalForceTorque> {
  CommandTraits traits() const override { return {.resource = Resource::none}; }

  void check(const Goal & goal, Check & check) const override
  {
    check.vector("wrench.force", goal.wrench.force, 5000.0, "N")
        .vector("wrench.torque", goal.wrench.torque, 500.0, "Nm")
        .answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const auto & f = goal.wrench.force;
    const auto & t = goal.wrench.torque;
    check_result(run.control()->setExternalForceTorque({f.x, f.y, f.z, t.x, t.y, t.z}), "take the reading");
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(SetExternalForceTorque, "set_external_force_torque")

}  // namespace ur_ros_rtde
