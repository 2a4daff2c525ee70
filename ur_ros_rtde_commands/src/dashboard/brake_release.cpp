#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class BrakeRelease : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override
  {
    return {"brake release", "Brake releasing", {"robotmode", {"RUNNING"}}};
  }
};

UR_ROS_RTDE_EXPORT(BrakeRelease, "dashboard/brake_release")

}  // namespace ur_ros_rtde
