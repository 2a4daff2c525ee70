#include <ur_ros_rtde/dashboard_command.hpp>

namespace my_package {

// The goal of DashboardText is a line of text; DashboardCommand and DashboardQuery have none. You can also
// use your own action.
class MyCommand : public ur_ros_rtde::DashboardCommand<ur_ros_rtde_msgs::action::DashboardText> {
  ur_ros_rtde::Outcome run(const Goal & goal, Run & run) override
  {
    if (auto shown = run.command("popup " + goal.text, "showing popup"); !shown) {
      return shown;
    }
    return run.query("robotmode");  // returns its answer in the result
  }
};

UR_ROS_RTDE_EXPORT(MyCommand, "dashboard/my_command")

}  // namespace my_package
