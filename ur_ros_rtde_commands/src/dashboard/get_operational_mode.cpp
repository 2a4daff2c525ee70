#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetOperationalMode : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 6}, never}; }
  Request request(const Goal &) const override { return {"get operational mode"}; }
};

UR_ROS_RTDE_EXPORT(GetOperationalMode, "dashboard/get_operational_mode")

}  // namespace ur_ros_rtde
