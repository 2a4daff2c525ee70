#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Shutdown : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Request request(const Goal &) const override { return {"shutdown", "Shutting down"}; }
};

UR_ROS_RTDE_EXPORT(Shutdown, "dashboard/shutdown")

}  // namespace ur_ros_rtde
