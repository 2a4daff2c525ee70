#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Popup : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Request request(const Goal & goal) const override { return {"popup " + goal.text, "showing popup"}; }
};

UR_ROS_RTDE_EXPORT(Popup, "dashboard/popup")

}  // namespace ur_ros_rtde
