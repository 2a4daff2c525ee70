#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetSafetyMode : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"safetymode"}; }
};

UR_ROS_RTDE_EXPORT(GetSafetyMode, "dashboard/safety_mode")

}  // namespace ur_ros_rtde
