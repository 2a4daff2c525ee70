#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PolyscopeVersion : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardQuery> {
  Outcome run(const Goal &, Run & run) override { return run.query("PolyscopeVersion"); }
};

UR_ROS_RTDE_EXPORT(PolyscopeVersion, "dashboard/polyscope_version")

}  // namespace ur_ros_rtde
