#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetRobotModel : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Limits limits() const override { return {{5, 6}, {3, 12}}; }
  Request request(const Goal &) const override { return {"get robot model"}; }
};

UR_ROS_RTDE_EXPORT(GetRobotModel, "dashboard/get_robot_model")

}  // namespace ur_ros_rtde
