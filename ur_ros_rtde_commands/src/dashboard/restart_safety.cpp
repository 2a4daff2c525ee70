#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class RestartSafety : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Limits limits() const override { return {{5, 1}, {3, 7}}; }
  Request request(const Goal &) const override
  {
    return {"restart safety", "Restarting safety", {"safetymode", {"NORMAL", "REDUCED"}}};
  }
};

UR_ROS_RTDE_EXPORT(RestartSafety, "dashboard/restart_safety")

}  // namespace ur_ros_rtde
