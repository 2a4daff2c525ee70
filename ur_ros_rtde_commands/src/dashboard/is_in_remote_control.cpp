#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class IsInRemoteControl : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 6}, never}; }
  Request request(const Goal &) const override { return {"is in remote control"}; }
};

UR_ROS_RTDE_EXPORT(IsInRemoteControl, "dashboard/is_in_remote_control")

}  // namespace ur_ros_rtde
