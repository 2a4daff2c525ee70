#include <ur_ros_rtde_msgs/action/get_coriolis_torques.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetCoriolisAndCentrifugalTorques : public QueryCommand<ur_ros_rtde_msgs::action::GetCoriolisTorques> {
  void check(const Goal & goal, Check & check) const override
  {
    check_optional_joints(check, "joint_positions", goal.joint_positions);
    check_optional_velocities(check, "joint_velocities", goal.joint_velocities)
        .polyscope(23)
        .answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const Sample now = run.state();
    const std::vector<double> q = or_current(goal.joint_positions, now.actual_q);
    const std::vector<double> qd = or_current(goal.joint_velocities, now.actual_qd);
    run.result().joint_torques = query(
        run, [&](auto & control) { return to_array6(control.getCoriolisAndCentrifugalTorques(q, qd)); });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetCoriolisAndCentrifugalTorques, "get_coriolis_and_centrifugal_torques")

}  // namespace ur_ros_rtde
