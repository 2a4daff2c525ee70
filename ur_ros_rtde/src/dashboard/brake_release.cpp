#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class BrakeRelease : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("brake release", "Brake releasing", Effect{"robotmode", {"RUNNING"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(BrakeRelease, "dashboard/brake_release")

}  // namespace ur_ros_rtde
