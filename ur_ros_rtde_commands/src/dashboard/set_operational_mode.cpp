#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class SetOperationalMode : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Limits limits() const override { return {{5, 0}, never, {"manual", "automatic"}}; }
  Request request(const Goal & goal) const override
  {
    return {"set operational mode " + goal.text, "Operational mode"};
  }
};

UR_ROS_RTDE_EXPORT(SetOperationalMode, "dashboard/set_operational_mode")

}  // namespace ur_ros_rtde
