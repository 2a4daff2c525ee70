#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class GetProgramState : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Request request(const Goal &) const override { return {"programState"}; }
};

UR_ROS_RTDE_EXPORT(GetProgramState, "dashboard/program_state")

}  // namespace ur_ros_rtde
