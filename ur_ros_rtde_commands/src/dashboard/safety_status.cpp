#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetSafetyStatus : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 4}, {3, 11}}; }
  Request request(const Goal &) const override { return {"safetystatus"}; }
};

UR_ROS_RTDE_EXPORT(GetSafetyStatus, "dashboard/safety_status")

}  // namespace ur_ros_rtde
