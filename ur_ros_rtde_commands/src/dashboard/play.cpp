#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Play : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override
  {
    return {"play", "Starting program", {"programState", {"PLAYING"}}};
  }
};

UR_ROS_RTDE_EXPORT(Play, "dashboard/play")

}  // namespace ur_ros_rtde
