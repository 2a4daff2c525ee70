#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class StopProgram : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override { return {"stop", "Stopped", {"programState", {"STOPPED"}}}; }
};

UR_ROS_RTDE_EXPORT(StopProgram, "dashboard/stop")

}  // namespace ur_ros_rtde
