#include <ur_ros_rtde_msgs/action/get_joint_values.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetTargetJointAccelerations : public QueryCommand<ur_ros_rtde_msgs::action::GetJointValues> {
  void check(const Goal &, Check & check) const override { check.polyscope(23).answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().values =
        query(run, [](auto & control) { return to_array6(control.getTargetJointAccelerations()); });
    run.result().unit = "rad/s^2";
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetTargetJointAccelerations, "get_target_joint_accelerations")

}  // namespace ur_ros_rtde
