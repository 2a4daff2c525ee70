#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Pause : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override
  {
    return {"pause", "Pausing program", {"programState", {"PAUSED"}}};
  }
};

UR_ROS_RTDE_EXPORT(Pause, "dashboard/pause")

}  // namespace ur_ros_rtde
