#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Running : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"running"}; }
};

UR_ROS_RTDE_EXPORT(Running, "dashboard/running")

}  // namespace ur_ros_rtde
