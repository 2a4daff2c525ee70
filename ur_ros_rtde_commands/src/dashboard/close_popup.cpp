#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class ClosePopup : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override { return {"close popup", "closing popup"}; }
};

UR_ROS_RTDE_EXPORT(ClosePopup, "dashboard/close_popup")

}  // namespace ur_ros_rtde
