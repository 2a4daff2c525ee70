#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <mutex>

#include "action_fixture.hpp"

using testing::ElementsAre;
using testing::UnorderedElementsAre;

namespace {
using ActionCancelTest = Actions;
}  // namespace

TEST_F(ActionCancelTest, CancelsGoal)
{
  serve();
  const auto goal = send(5);
  const auto handle = accepted(0);
  const auto response = get(goal->async_cancel());
  EXPECT_EQ(response.code, CancelCode::none);
  EXPECT_THAT(response.goals, ElementsAre(goal->get_goal_id()));
  EXPECT_TRUE(handle->is_canceling());
  EXPECT_TRUE(handle->canceled(result_of({1})));
  EXPECT_EQ(result(goal).status, GoalStatus::canceled);
  EXPECT_THAT(result(goal).result.sequence, ElementsAre(1));
}

TEST_F(ActionCancelTest, LeavesGoalExecutingWhenRejected)
{
  serve();
  on_cancel = [](Handle &) { return false; };
  const auto goal = send(5);
  const auto handle = accepted(0);
  const auto response = get(goal->async_cancel());
  EXPECT_EQ(response.code, CancelCode::rejected);
  EXPECT_TRUE(response.goals.empty());
  EXPECT_EQ(handle->get_status(), GoalStatus::executing);
  EXPECT_TRUE(handle->succeed());
}

TEST_F(ActionCancelTest, IsRejectedWhenHandleCancelThrows)
{
  serve();
  on_cancel = [](Handle &) -> bool { throw std::runtime_error("is logged"); };
  const auto goal = send(5);
  EXPECT_EQ(get(goal->async_cancel()).code, CancelCode::rejected);
  EXPECT_TRUE(accepted(0)->is_active());
}

TEST_F(ActionCancelTest, MayBeCompletedInHandleCancel)
{
  serve();
  on_cancel = [](Handle & handle) { return handle.canceled(result_of({3})); };
  const auto goal = send(5);
  const auto response = get(goal->async_cancel());
  EXPECT_EQ(response.code, CancelCode::none);
  EXPECT_EQ(result(goal).status, GoalStatus::canceled);
}

TEST_F(ActionCancelTest, IsTooLateAfterResult)
{
  serve();
  on_cancel = [](Handle & handle) {
    handle.succeed();
    return true;
  };
  const auto goal = send(5);
  const auto response = get(goal->async_cancel());
  EXPECT_EQ(response.code, CancelCode::goal_terminated);
  EXPECT_TRUE(response.goals.empty());
  EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
  EXPECT_EQ(get(goal->async_cancel()).code, CancelCode::goal_terminated);
}

TEST_F(ActionCancelTest, ReportsUnknownGoal)
{
  serve();
  EXPECT_EQ(get(client->async_cancel_goal(rcl_cxx::GoalUUID::random())).code, CancelCode::unknown_goal);
}

TEST_F(ActionCancelTest, CancelsAllOrEarlierGoals)
{
  serve();
  const auto one = send(1);
  const auto two = send(2);
  const auto three = send(3);
  EXPECT_THAT(get(client->async_cancel_goals_before(accepted(1)->get_goal_stamp())).goals,
              UnorderedElementsAre(one->get_goal_id(), two->get_goal_id()));
  EXPECT_FALSE(accepted(2)->is_canceling());
  EXPECT_THAT(get(client->async_cancel_all_goals()).goals, ElementsAre(three->get_goal_id()));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(accepted(i)->canceled());
  }
  const auto nothing = get(client->async_cancel_all_goals());
  EXPECT_EQ(nothing.code, CancelCode::none);
  EXPECT_TRUE(nothing.goals.empty());
}

TEST_F(ActionCancelTest, LosesNoGoalInRaceWithResults)
{
  serve();
  for (std::size_t round = 0; round < 20; ++round) {
    const auto goal = send(1);
    const auto handle = accepted(round);
    std::thread worker([&] {
      if (!(handle->is_canceling() && handle->canceled())) {
        handle->succeed();
      }
    });
    const auto response = get(goal->async_cancel());
    worker.join();
    const GoalStatus end = result(goal).status;
    EXPECT_TRUE(end == GoalStatus::canceled || end == GoalStatus::succeeded);
    EXPECT_TRUE(response.code == CancelCode::none || end == GoalStatus::succeeded);
  }
}
