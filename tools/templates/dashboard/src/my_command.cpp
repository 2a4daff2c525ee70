#include <ur_ros_rtde/dashboard_command.hpp>

namespace my_package {

// DashboardText has a line of text as its goal. DashboardCommand and DashboardQuery need none; an action of
// your own does, too.
class MyCommand : public ur_ros_rtde::DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    if (auto shown = run.command("popup " + goal.text, "showing popup"); !shown) {
      return shown;
    }
    return run.query("robotmode");  // the answer is the result's
  }
};

UR_ROS_RTDE_EXPORT(MyCommand, "dashboard/my_command")

}  // namespace my_package
