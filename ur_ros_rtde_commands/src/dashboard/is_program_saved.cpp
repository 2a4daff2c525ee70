#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class IsProgramSaved : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"isProgramSaved"}; }
};

UR_ROS_RTDE_EXPORT(IsProgramSaved, "dashboard/is_program_saved")

}  // namespace ur_ros_rtde
