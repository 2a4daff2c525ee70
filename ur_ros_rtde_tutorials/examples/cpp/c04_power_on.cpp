// c04: powers the arm on and releases its brakes through the dashboard server. An arm that is on already
// stays on.
//
// Keep clear of the arm: it sinks slightly when the brakes are released. make_ready does these and further
// steps in one goal.
//
// ros2 run ur_ros_rtde_tutorials c04_power_on

#include <string>
#include <ur_ros_rtde_msgs/action/dashboard_command.hpp>
#include <ur_ros_rtde_msgs/action/dashboard_query.hpp>

#include "goal_client.hpp"

using DashboardCommand = ur_ros_rtde_msgs::action::DashboardCommand;
using DashboardQuery = ur_ros_rtde_msgs::action::DashboardQuery;

int main(int argc, char ** argv)
{
  return goal_client::run(argc, argv, [] {
    const auto node = std::make_shared<rclcpp::Node>("c04_power_on");
    for (const std::string name : {"dashboard/power_on", "dashboard/brake_release"}) {
      goal_client::GoalClient<DashboardCommand> client(node, name);
      const auto show_state = [&name](const DashboardCommand::Feedback & feedback) {
        std::printf("%s: %s\n", name.c_str(), feedback.state.c_str());
      };
      const int code =
          goal_client::report(client.send(DashboardCommand::Goal(), std::chrono::seconds(90), show_state));
      if (code != 0) {
        return code;
      }
    }
    goal_client::GoalClient<DashboardQuery> client(node, "dashboard/robot_mode");
    const auto mode = client.send(DashboardQuery::Goal(), std::chrono::seconds(10));
    std::printf("robot mode: %s\n", mode.result->answer.c_str());
    return goal_client::report(mode);
  });
}
