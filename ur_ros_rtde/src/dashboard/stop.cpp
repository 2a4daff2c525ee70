#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class StopProgram : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("stop", "Stopped", Effect{"programState", {"STOPPED"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(StopProgram, "dashboard/stop")

}  // namespace ur_ros_rtde
