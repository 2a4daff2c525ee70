#pragma once

#include <ur_ros_rtde_msgs/action/make_ready.hpp>
#include <ur_ros_rtde_msgs/action/move_j.hpp>

#include "client_test.hpp"

using ur_ros_rtde_msgs::action::MakeReady;
using ur_ros_rtde_msgs::action::MoveJ;

inline const std::vector<double> home{0.0, -1.57, 1.57, -1.57, -1.57, 0.0};

inline std::vector<double> base_turned_by(double angle)
{
  std::vector<double> joints = home;
  joints[0] += angle;
  return joints;
}

inline MoveJ::Goal move_to(const std::vector<double> & joints, double speed)
{
  MoveJ::Goal goal;
  goal.joint_positions = joints;
  goal.speed = speed;
  goal.acceleration = 2.0;
  return goal;
}

/// Each test begins with the robot ready and the arm at home.
class MotionTest : public ClientTest {
 protected:
  void SetUp() override
  {
    SentGoal<MakeReady> ready(action_client<MakeReady>(node, "make_ready"), MakeReady::Goal());
    ASSERT_TRUE(ready.accepted());
    ASSERT_EQ(ready.result().code, rclcpp_action::ResultCode::SUCCEEDED);
    move_j = action_client<MoveJ>(node, "move_j");
    SentGoal<MoveJ> goal(move_j, move_to(home, 2.0));
    ASSERT_TRUE(goal.accepted());
    ASSERT_EQ(goal.result().code, rclcpp_action::ResultCode::SUCCEEDED);
  }

  bool moves()
  {
    return eventually([this] { return arm.speed() > 0.1; });
  }

  Arm arm{*node};
  rclcpp_action::Client<MoveJ>::SharedPtr move_j;
};
