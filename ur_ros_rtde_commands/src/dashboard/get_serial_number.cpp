#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetSerialNumber : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 6}, {3, 12}}; }
  Request request(const Goal &) const override { return {"get serial number"}; }
};

UR_ROS_RTDE_EXPORT(GetSerialNumber, "dashboard/get_serial_number")

}  // namespace ur_ros_rtde
