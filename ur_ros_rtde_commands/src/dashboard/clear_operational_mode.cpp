#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class ClearOperationalMode : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Limits limits() const override { return {{5, 0}, never}; }
  Request request(const Goal &) const override
  {
    return {"clear operational mode", "No longer controlling the operational mode"};
  }
};

UR_ROS_RTDE_EXPORT(ClearOperationalMode, "dashboard/clear_operational_mode")

}  // namespace ur_ros_rtde
