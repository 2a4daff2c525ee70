#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetUserRole : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {never, {3, 1}}; }
  Request request(const Goal &) const override { return {"getUserRole"}; }
};

UR_ROS_RTDE_EXPORT(GetUserRole, "dashboard/get_user_role")

}  // namespace ur_ros_rtde
