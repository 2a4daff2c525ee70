#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class CloseSafetyPopup : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Limits limits() const override { return {{5, 0}, {3, 1}}; }
  Request request(const Goal &) const override { return {"close safety popup", "closing safety popup"}; }
};

UR_ROS_RTDE_EXPORT(CloseSafetyPopup, "dashboard/close_safety_popup")

}  // namespace ur_ros_rtde
