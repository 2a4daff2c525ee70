#include <ur_ros_rtde_msgs/action/get_joint_values.hpp>

#include "queries/question.hpp"

namespace ur_ros_rtde {

class GetJointTorques : public Question<ur_ros_rtde_msgs::action::GetJointValues> {
  void check(const Goal &, Check & check) const override { check.answers(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().values = answer(run, [](auto & control) { return six(control.getJointTorques()); });
    run.result().unit = "Nm";
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetJointTorques, "get_joint_torques")

}  // namespace ur_ros_rtde
