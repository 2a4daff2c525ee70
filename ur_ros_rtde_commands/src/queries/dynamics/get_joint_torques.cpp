#include <ur_ros_rtde_msgs/action/get_joint_values.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetJointTorques : public QueryCommand<ur_ros_rtde_msgs::action::GetJointValues> {
  void check(const Goal &, Check & check) const override { check.answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().values = query(run, [](auto & control) { return to_array6(control.getJointTorques()); });
    run.result().unit = "Nm";
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJointTorques, "get_joint_torques")

}  // namespace ur_ros_rtde
