#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class UnlockProtectiveStop : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Limits limits() const override { return {{5, 0}, {3, 1}}; }
  Request request(const Goal &) const override
  {
    return {"unlock protective stop", "Protective stop releasing", {"safetymode", {"NORMAL", "REDUCED"}}};
  }
};

UR_ROS_RTDE_EXPORT(UnlockProtectiveStop, "dashboard/unlock_protective_stop")

}  // namespace ur_ros_rtde
