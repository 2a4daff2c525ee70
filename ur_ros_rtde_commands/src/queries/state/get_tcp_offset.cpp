#include <ur_ros_rtde_msgs/action/get_pose.hpp>

#include "queries/query_command.hpp"

namespace ur_ros_rtde {

class GetTcpOffset : public QueryCommand<ur_ros_rtde_msgs::action::GetPose> {
  void check(const Goal &, Check & check) const override { check.polyscope(0, 6).answers_queries(); }

  Outcome run(const Goal &, Run & run) override
  {
    run.result().pose = query(run, [](auto & control) { return to_pose(control.getTCPOffset()); });
    run.result().frame = "tool0";  // the flange, not the TCP
    return Outcome::success();
  }
};

UR_ROS_RTDE_EXPORT(GetTcpOffset, "get_tcp_offset")

}  // namespace ur_ros_rtde
