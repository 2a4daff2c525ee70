#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class UnlockProtectiveStop : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("unlock protective stop", "Protective stop releasing",
                       Effect{"safetymode", {"NORMAL", "REDUCED"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(UnlockProtectiveStop, "dashboard/unlock_protective_stop")

}  // namespace ur_ros_rtde
