// c01: sends a goal, shows its progress and reads its result.
//
// Rotates wrist 3 by a quarter turn. Ctrl-C, SIGTERM and SIGHUP cancel the goal, and the arm decelerates.
//
// ros2 run ur_ros_rtde_tutorials c01_send_a_goal
// ros2 run ur_ros_rtde_tutorials c01_send_a_goal --ros-args -p speed:=0.2

#include <cmath>
#include <ur_ros_rtde_msgs/action/move_j.hpp>
#include <ur_ros_rtde_msgs/srv/get_joint_state.hpp>
#include <vector>

#include "goal_client.hpp"

using MoveJ = ur_ros_rtde_msgs::action::MoveJ;
using GetJointState = ur_ros_rtde_msgs::srv::GetJointState;

/// The current joint positions, in the order of the goal.
std::vector<double> get_joint_positions(const rclcpp::Node::SharedPtr & node)
{
  const auto client = node->create_client<GetJointState>("get_joint_state");
  if (!client->wait_for_service(std::chrono::seconds(10))) {
    throw std::runtime_error("robot_state_receiver is not running: start the driver first");
  }
  const auto request = client->async_send_request(std::make_shared<GetJointState::Request>()).future.share();
  const auto response =
      goal_client::wait_for(node, request, std::chrono::seconds(5), "response of get_joint_state");
  if (!response->success) {
    throw std::runtime_error(response->message);
  }
  return response->joint_state.position;
}

int main(int argc, char ** argv)
{
  return goal_client::run(argc, argv, [] {
    const auto node = std::make_shared<rclcpp::Node>("c01_send_a_goal");
    MoveJ::Goal goal;
    goal.joint_positions = get_joint_positions(node);
    auto & wrist_3 = goal.joint_positions.at(5);
    wrist_3 += wrist_3 > 0.0 ? -M_PI_2 : M_PI_2;
    goal.speed = node->declare_parameter("speed", 0.5);
    goal.acceleration = 1.0;

    goal_client::GoalClient<MoveJ> client(node, "move_j");
    const auto show_progress = [](const MoveJ::Feedback & feedback) {
      std::printf("\r%5.1f %%", 100.0 * feedback.motion.progress);
      std::fflush(stdout);
    };
    return goal_client::report(client.send(goal, std::chrono::seconds(60), show_progress));
  });
}
