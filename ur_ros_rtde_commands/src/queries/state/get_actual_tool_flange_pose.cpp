#include <ur_ros_rtde_msgs/action/get_pose.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetActualToolFlangePose : public QueryCommand<ur_ros_rtde_msgs::action::GetPose> {
  void check(const Goal &, Check & check) const override { check.answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().pose = query(run, [](auto & control) { return to_pose(control.getActualToolFlangePose()); });
    run.result().frame = "base";
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetActualToolFlangePose, "get_actual_tool_flange_pose")

}  // namespace ur_ros_rtde
