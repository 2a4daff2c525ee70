#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class SaveLog : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Limits limits() const override { return {{5, 8}, {3, 13}}; }
  Request request(const Goal &) const override { return {"saveLog", "Log saved to disk"}; }
};

UR_ROS_RTDE_EXPORT(SaveLog, "dashboard/save_log")

}  // namespace ur_ros_rtde
