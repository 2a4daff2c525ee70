#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class LoadInstallation : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Limits limits() const override { return {{5, 0}, {3, 2}}; }
  Request request(const Goal & goal) const override
  {
    return {"load installation " + goal.text, "Loading installation: "};
  }
};

UR_ROS_RTDE_EXPORT(LoadInstallation, "dashboard/load_installation")

}  // namespace ur_ros_rtde
