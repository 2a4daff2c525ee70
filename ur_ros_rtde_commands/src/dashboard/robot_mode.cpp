#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetRobotMode : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"robotmode"}; }
};

UR_ROS_RTDE_EXPORT(GetRobotMode, "dashboard/robot_mode")

}  // namespace ur_ros_rtde
