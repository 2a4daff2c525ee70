#include <gmock/gmock.h>

#include <action_msgs/srv/cancel_goal.hpp>
#include <ur_ros_rtde_msgs/action/stop.hpp>
#include <ur_ros_rtde_msgs/action/trigger.hpp>
#include <ur_ros_rtde_msgs/msg/error_code.hpp>
#include <ur_ros_rtde_msgs/msg/goal_rejected.hpp>

#include "motion_test.hpp"

using action_msgs::srv::CancelGoal;
using rclcpp_action::ResultCode;
using testing::HasSubstr;
using ur_ros_rtde_msgs::action::Stop;
using ur_ros_rtde_msgs::action::Trigger;
using ur_ros_rtde_msgs::msg::ErrorCode;
using ur_ros_rtde_msgs::msg::GoalRejected;

namespace {

class ActionCheck : public MotionTest {
 protected:
  /// Returns the message of the newest rejection of an action, from the latched topic.
  std::string rejection(const std::string & action)
  {
    std::string message;
    eventually([&] {
      for (const auto & rejected : rejections_.messages()) {
        message = rejected->action == action ? rejected->message : message;
      }
      return !message.empty();
    });
    return message;
  }

 private:
  MessageCollector<GoalRejected> rejections_{*node, "goal_rejections", rclcpp::QoS(100).transient_local()};
};

TEST_F(ActionCheck, GoalSucceedsWithFeedback)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(0.5), 0.5));
  ASSERT_TRUE(goal.accepted());
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::SUCCEEDED);
  EXPECT_TRUE(result.result->success) << result.result->message;
  EXPECT_NEAR(result.result->final_state.joint_positions[0], 0.5, 0.002);
  EXPECT_TRUE(eventually([&] { return arm.at(base_turned_by(0.5)); }));
  const auto feedback = goal.feedback();
  ASSERT_GT(feedback.size(), 10U);  // 20 Hz
  EXPECT_GT(feedback.back().motion.progress, feedback.front().motion.progress);
}

TEST_F(ActionCheck, CancelEndsAtStandstill)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(2.0), 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  const auto response = value_of(move_j->async_cancel_goal(goal.handle()));
  EXPECT_EQ(response->return_code, CancelGoal::Response::ERROR_NONE);
  EXPECT_EQ(response->goals_canceling.size(), 1U);
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::CANCELED);
  EXPECT_EQ(result.result->error_code, ErrorCode::CANCELED);
  const double stopped_at = result.result->final_state.joint_positions[0];
  EXPECT_GT(stopped_at, 0.0);
  EXPECT_LT(stopped_at, 1.9);
  EXPECT_TRUE(eventually([&] { return arm.at_rest() && arm.at(base_turned_by(stopped_at)); }));
}

TEST_F(ActionCheck, AllGoalsAreCanceledAtOnce)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(2.0), 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  EXPECT_EQ(value_of(move_j->async_cancel_all_goals())->goals_canceling.size(), 1U);
  EXPECT_EQ(goal.result().code, ResultCode::CANCELED);
}

TEST_F(ActionCheck, CancelOfAnEndedGoalIsRejected)
{
  SentGoal<MoveJ> goal(move_j, move_to(home, 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_EQ(goal.result().code, ResultCode::SUCCEEDED);
  // rclcpp forgets a goal whose result it has, so this asks for all goals until now.
  const auto response = value_of(move_j->async_cancel_goals_before(node->now()));
  EXPECT_TRUE(response->goals_canceling.empty());
}

TEST_F(ActionCheck, WrongGoalIsRejectedWithReason)
{
  SentGoal<MoveJ> goal(move_j, move_to(home, -1.0));
  EXPECT_FALSE(goal.accepted());
  EXPECT_THAT(rejection("/move_j"), HasSubstr("speed"));
}

TEST_F(ActionCheck, SecondMotionIsRejectedAsBusy)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(2.0), 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  SentGoal<MoveJ> second(move_j, move_to(home, 0.5));
  EXPECT_FALSE(second.accepted());
  EXPECT_TRUE(eventually([&] { return rejection("/move_j").find("move_j") != std::string::npos; }));
  value_of(move_j->async_cancel_goal(goal.handle()));
  EXPECT_EQ(goal.result().code, ResultCode::CANCELED);
}

TEST_F(ActionCheck, StopAbortsTheRunningGoal)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(2.0), 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  SentGoal<Stop> stop(action_client<Stop>(node, "stop"), Stop::Goal());
  ASSERT_TRUE(stop.accepted());
  EXPECT_EQ(stop.result().code, ResultCode::SUCCEEDED);
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::ABORTED);
  EXPECT_EQ(result.result->error_code, ErrorCode::PREEMPTED);
  EXPECT_TRUE(eventually([&] { return arm.at_rest(); }));
}

TEST_F(ActionCheck, ProtectiveStopAbortsTheRunningGoal)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(2.0), 0.5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  SentGoal<Trigger> trigger(action_client<Trigger>(node, "trigger_protective_stop"), Trigger::Goal());
  ASSERT_TRUE(trigger.accepted());
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::ABORTED);
  EXPECT_EQ(result.result->error_code, ErrorCode::PROTECTIVE_STOP);
  EXPECT_EQ(trigger.result().code, ResultCode::SUCCEEDED);
  EXPECT_TRUE(eventually([&] { return arm.at_rest(); }));
}

TEST_F(ActionCheck, ResultMayBeAskedForLate)
{
  SentGoal<MoveJ> goal(move_j, move_to(base_turned_by(0.1), 1.0));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(eventually([&] { return arm.at(base_turned_by(0.1)); }));
  ASSERT_TRUE(
      eventually([&] { return goal.handle()->get_status() == rclcpp_action::GoalStatus::STATUS_SUCCEEDED; }));
  EXPECT_TRUE(goal.result().result->success);
}

}  // namespace
