#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PolyscopeVersion : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"PolyscopeVersion"}; }
};

UR_ROS_RTDE_EXPORT(PolyscopeVersion, "dashboard/polyscope_version")

}  // namespace ur_ros_rtde
