// c03: moves through waypoints in one motion, without a stop in between, and shows the remaining time.
//
// The path is planned within the limits of the joints and checked before the arm moves. Ctrl-C decelerates
// along the path.
//
// ros2 run ur_ros_rtde_tutorials c03_waypoints

#include <ur_ros_rtde_msgs/action/execute_trajectory.hpp>

#include "goal_client.hpp"

using ExecuteTrajectory = ur_ros_rtde_msgs::action::ExecuteTrajectory;

int main(int argc, char ** argv)
{
  return goal_client::run(argc, argv, [] {
    const auto node = std::make_shared<rclcpp::Node>("c03_waypoints");
    ExecuteTrajectory::Goal goal;
    for (const double base : {0.0, 0.3, 0.6, 0.3}) {
      ur_ros_rtde_msgs::msg::JointWaypoint waypoint;
      waypoint.positions = {base, -1.57 - 0.2 * base, 1.57, -1.57, -1.57, 0.5 * base};
      goal.waypoints.push_back(waypoint);
    }
    goal.blend_tolerance = 0.02;
    goal.approach = true;  // the arm moves to the first waypoint before

    goal_client::GoalClient<ExecuteTrajectory> client(node, "execute_trajectory");
    const auto show_progress = [](const ExecuteTrajectory::Feedback & feedback) {
      std::printf("\rwaypoint %u, %4.1f s left ", feedback.waypoint, feedback.time_left);
      std::fflush(stdout);
    };
    return goal_client::report(client.send(goal, std::chrono::seconds(120), show_progress));
  });
}
