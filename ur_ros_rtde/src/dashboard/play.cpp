#include "ur_ros_rtde/dashboard_command.hpp"

namespace ur_ros_rtde {

class Play : public DashboardCommand<ur_ros_rtde_msgs::action::DashboardCommand> {
  Outcome run(const Goal & goal, Run & run) override
  {
    return run.command("play", "Starting program", Effect{"programState", {"PLAYING"}}, goal.timeout);
  }
};

UR_ROS_RTDE_EXPORT(Play, "dashboard/play")

}  // namespace ur_ros_rtde
