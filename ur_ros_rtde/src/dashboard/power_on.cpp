#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PowerOn : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("power on", "Powering on", Effect{"robotmode", {"IDLE", "RUNNING"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(PowerOn, "dashboard/power_on")

}  // namespace ur_ros_rtde
