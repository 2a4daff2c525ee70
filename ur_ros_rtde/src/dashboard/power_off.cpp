#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class PowerOff : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("power off", "Powering off", Effect{"robotmode", {"POWER_OFF"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(PowerOff, "dashboard/power_off")

}  // namespace ur_ros_rtde
