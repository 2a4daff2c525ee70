#include <ur_ros_rtde_msgs/action/get_mass_matrix.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetMassMatrix : public QueryCommand<ur_ros_rtde_msgs::action::GetMassMatrix> {
  void check(const Goal & goal, Check & check) const override
  {
    check_optional_joints(check, "joint_positions", goal.joint_positions).polyscope(23).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    const std::vector<double> q = or_current(goal.joint_positions, run.state().actual_q);
    run.result().matrix = query(run, [&](auto & control) {
      return to_row_major(control.getMassMatrix(q, goal.include_rotor_inertia));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetMassMatrix, "get_mass_matrix")

}  // namespace ur_ros_rtde
