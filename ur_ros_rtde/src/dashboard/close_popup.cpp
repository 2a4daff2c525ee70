#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class ClosePopup : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal &, Run & run) override { return run.command("close popup", "closing popup"); }
};

UR_ROS_RTDE_EXPORT(ClosePopup, "dashboard/close_popup")

}  // namespace ur_ros_rtde
