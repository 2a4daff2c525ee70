// A client to be killed: sends a long motion and waits for its end. Prints "moving" when the arm moves.

#include <cstdio>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_action/rclcpp_action.hpp>
#include <ur_ros_rtde_msgs/action/move_j.hpp>

using MoveJ = ur_ros_rtde_msgs::action::MoveJ;
using Client = rclcpp_action::Client<MoveJ>;

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<rclcpp::Node>("moving_client");
  const auto client = rclcpp_action::create_client<MoveJ>(node, "move_j");
  if (!client->wait_for_action_server(std::chrono::seconds(10))) {
    return 1;
  }
  MoveJ::Goal goal;
  goal.joint_positions = {3.0, -1.57, 1.57, -1.57, -1.57, 0.0};
  goal.speed = 0.1;
  goal.acceleration = 1.0;
  Client::SendGoalOptions options;
  options.feedback_callback = [printed = false](auto, auto feedback) mutable {
    if (!printed && feedback->motion.progress > 0.01) {
      printed = true;
      std::puts("moving");
      std::fflush(stdout);
    }
  };
  options.result_callback = [](const Client::GoalHandle::WrappedResult &) { rclcpp::shutdown(); };
  client->async_send_goal(goal, options);
  rclcpp::spin(node);
  rclcpp::shutdown();
  return 0;
}
