#include <ur_ros_rtde_msgs/action/get_joint_positions_history.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetActualJointPositionsHistory
    : public QueryCommand<ur_ros_rtde_msgs::action::GetJointPositionsHistory> {
  void check(const Goal & goal, Check & check) const override
  {
    check.in_range("steps", goal.steps, 0, 100).polyscope(4).answers_queries();
  }

  Outcome run(const Goal & goal, Run & run) override
  {
    run.result().joint_positions = query(run, [&](auto & control) {
      return to_array6(control.getActualJointPositionsHistory(static_cast<int>(goal.steps)));
    });
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetActualJointPositionsHistory, "get_actual_joint_positions_history")

}  // namespace ur_ros_rtde
