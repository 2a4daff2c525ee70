#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetVersion : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 0}, never}; }
  Request request(const Goal &) const override { return {"version"}; }
};

UR_ROS_RTDE_EXPORT(GetVersion, "dashboard/version")

}  // namespace ur_ros_rtde
