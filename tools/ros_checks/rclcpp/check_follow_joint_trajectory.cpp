#include <gmock/gmock.h>

#include <control_msgs/action/follow_joint_trajectory.hpp>

#include "motion_test.hpp"

using control_msgs::action::FollowJointTrajectory;
using rclcpp_action::ResultCode;
using Result = FollowJointTrajectory::Result;

namespace {

class FollowJointTrajectoryCheck : public MotionTest {
 protected:
  void SetUp() override
  {
    MotionTest::SetUp();
    follow = action_client<FollowJointTrajectory>(node, "follow_joint_trajectory");
  }

  /// Returns a trajectory from home that turns the base joint by `angle`.
  FollowJointTrajectory::Goal turn(double angle, int seconds)
  {
    FollowJointTrajectory::Goal goal;
    goal.trajectory.joint_names = {"shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
                                   "wrist_1_joint",      "wrist_2_joint",       "wrist_3_joint"};
    for (const int time : {0, seconds}) {
      auto & point = goal.trajectory.points.emplace_back();
      point.positions = base_turned_by(time == 0 ? 0.0 : angle);
      point.velocities.assign(6, 0.0);
      point.time_from_start.sec = time;
    }
    return goal;
  }

  rclcpp_action::Client<FollowJointTrajectory>::SharedPtr follow;
};

TEST_F(FollowJointTrajectoryCheck, TrajectoryIsExecuted)
{
  SentGoal<FollowJointTrajectory> goal(follow, turn(0.5, 2));
  ASSERT_TRUE(goal.accepted());
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::SUCCEEDED);
  EXPECT_EQ(result.result->error_code, Result::SUCCESSFUL) << result.result->error_string;
  EXPECT_TRUE(eventually([&] { return arm.at(base_turned_by(0.5)); }));
  const auto feedback = goal.feedback();
  ASSERT_GT(feedback.size(), 10U);
  EXPECT_THAT(feedback.back().joint_names, testing::SizeIs(6));
  EXPECT_THAT(feedback.back().actual.positions, testing::SizeIs(6));
}

TEST_F(FollowJointTrajectoryCheck, CancelEndsAtStandstill)
{
  SentGoal<FollowJointTrajectory> goal(follow, turn(1.0, 5));
  ASSERT_TRUE(goal.accepted());
  ASSERT_TRUE(moves());
  value_of(follow->async_cancel_goal(goal.handle()));
  EXPECT_EQ(goal.result().code, ResultCode::CANCELED);
  EXPECT_TRUE(eventually([&] { return arm.at_rest(); }));
}

TEST_F(FollowJointTrajectoryCheck, PathToleranceAborts)
{
  auto request = turn(1.0, 3);
  auto & tolerance = request.path_tolerance.emplace_back();
  tolerance.name = "shoulder_pan_joint";
  tolerance.position = 1e-6;
  SentGoal<FollowJointTrajectory> goal(follow, request);
  ASSERT_TRUE(goal.accepted());
  const auto result = goal.result();
  EXPECT_EQ(result.code, ResultCode::ABORTED);
  EXPECT_EQ(result.result->error_code, Result::PATH_TOLERANCE_VIOLATED);
  EXPECT_THAT(result.result->error_string, testing::HasSubstr("shoulder_pan_joint"));
}

TEST_F(FollowJointTrajectoryCheck, WrongJointNamesAreRejected)
{
  auto request = turn(0.5, 2);
  request.trajectory.joint_names[0] = "finger_joint";
  EXPECT_FALSE(SentGoal<FollowJointTrajectory>(follow, request).accepted());
}

}  // namespace
