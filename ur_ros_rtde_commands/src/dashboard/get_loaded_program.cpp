#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetLoadedProgram : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"get loaded program"}; }
};

UR_ROS_RTDE_EXPORT(GetLoadedProgram, "dashboard/get_loaded_program")

}  // namespace ur_ros_rtde
