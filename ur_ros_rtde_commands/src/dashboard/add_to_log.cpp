#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class AddToLog : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Request request(const Goal & goal) const override { return {"addToLog " + goal.text, "Added log message"}; }
};

UR_ROS_RTDE_EXPORT(AddToLog, "dashboard/add_to_log")

}  // namespace ur_ros_rtde
