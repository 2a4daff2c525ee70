#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PowerOff : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override
  {
    return {"power off", "Powering off", {"robotmode", {"POWER_OFF"}}};
  }
};

UR_ROS_RTDE_EXPORT(PowerOff, "dashboard/power_off")

}  // namespace ur_ros_rtde
