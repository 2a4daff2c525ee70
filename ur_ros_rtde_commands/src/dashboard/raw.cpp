#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Raw : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  Outcome run(const Goal & goal, Run & run) override { return run.raw(goal.text); }
};

UR_ROS_RTDE_EXPORT(Raw, "dashboard/raw")

}  // namespace ur_ros_rtde
