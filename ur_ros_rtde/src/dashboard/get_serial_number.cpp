#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetSerialNumber : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Outcome run(const Goal &, Run & run) override { return run.query("get serial number"); }
};

UR_ROS_RTDE_EXPORT(GetSerialNumber, "dashboard/get_serial_number")

}  // namespace ur_ros_rtde
