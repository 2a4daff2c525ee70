#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PowerOn : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override
  {
    return {"power on", "Powering on", {"robotmode", {"IDLE", "RUNNING"}}};
  }
};

UR_ROS_RTDE_EXPORT(PowerOn, "dashboard/power_on")

}  // namespace ur_ros_rtde
