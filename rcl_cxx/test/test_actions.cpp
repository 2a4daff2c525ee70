#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <optional>

#include "action_fixture.hpp"

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {
using ActionGoalTest = Actions;
using ActionServerTest = Actions;
using GoalIdTest = Actions;
using SendGoalTest = Actions;
}  // namespace

TEST_F(ActionGoalTest, EndsWithItsResult)
{
  serve();
  const auto goal = send(5);
  ASSERT_TRUE(goal);
  const auto handle = accepted(0);
  EXPECT_EQ(handle->get_goal().order, 5);
  EXPECT_EQ(handle->get_goal_id(), goal->get_goal_id());
  EXPECT_EQ(handle->get_status(), GoalStatus::executing);
  EXPECT_TRUE(handle->succeed(result_of({0, 1, 1})));
  EXPECT_EQ(handle->get_status(), GoalStatus::succeeded);
  EXPECT_FALSE(handle->is_active());
  const auto end = result(goal);
  EXPECT_EQ(end.status, GoalStatus::succeeded);
  EXPECT_THAT(end.result.sequence, ElementsAre(0, 1, 1));
  EXPECT_EQ(goal->get_status(), GoalStatus::succeeded);
}

TEST_F(ActionGoalTest, TakesExactlyOneResult)
{
  serve();
  const auto goal = send(5);
  const auto handle = accepted(0);
  EXPECT_TRUE(handle->abort(result_of({7})));
  EXPECT_FALSE(handle->succeed(result_of({8})));
  EXPECT_FALSE(handle->abort(result_of({9})));
  EXPECT_FALSE(handle->canceled());
  EXPECT_FALSE(handle->publish_feedback(Fibonacci::Feedback()));
  EXPECT_EQ(result(goal).status, GoalStatus::aborted);
  EXPECT_THAT(result(goal).result.sequence, ElementsAre(7));
}

TEST_F(ActionGoalTest, TakesFirstResultOfRacingThreads)
{
  serve();
  for (std::size_t round = 0; round < 20; ++round) {
    const auto goal = send(5);
    const auto handle = accepted(round);
    std::atomic<int> taken{0};
    std::vector<std::thread> workers;
    for (int t = 0; t < 4; ++t) {
      workers.emplace_back([&, t] { taken += (t % 2 == 0 ? handle->succeed() : handle->abort()) ? 1 : 0; });
    }
    for (std::thread & worker : workers) {
      worker.join();
    }
    EXPECT_EQ(taken, 1);
    EXPECT_EQ(result(goal).status, handle->get_status());
  }
}

TEST_F(ActionGoalTest, CannotBeCanceledWithoutCancelRequest)
{
  serve();
  const auto goal = send(5);
  const auto handle = accepted(0);
  EXPECT_FALSE(handle->canceled());
  EXPECT_TRUE(handle->is_active());
  EXPECT_TRUE(handle->abort());
}

TEST_F(ActionGoalTest, IsAbortedWhenItsHandleIsReleased)
{
  serve();
  on_accepted = [](std::shared_ptr<Handle>) {};
  const auto goal = send(5);
  EXPECT_EQ(result(goal).status, GoalStatus::aborted);
  EXPECT_TRUE(result(goal).result.sequence.empty());
}

TEST_F(ActionGoalTest, IsAbortedWhenHandleAcceptedThrows)
{
  serve();
  on_accepted = [](std::shared_ptr<Handle>) { throw std::runtime_error("is logged"); };
  EXPECT_EQ(result(send(5)).status, GoalStatus::aborted);
}

TEST_F(ActionGoalTest, IsRejectedByReasonOrException)
{
  serve();
  on_goal = [](const rcl_cxx::GoalUUID &, const Fibonacci::Goal & goal) -> tl::expected<void, std::string> {
    if (goal.order == 1) {
      throw std::runtime_error("is logged");
    }
    return tl::make_unexpected(std::string("not today"));
  };
  EXPECT_FALSE(send(0));
  EXPECT_FALSE(send(1));
  EXPECT_THAT(handles, IsEmpty());
}

TEST_F(GoalIdTest, IsRejectedWithoutCallingHandleGoalWhileInUse)
{
  serve();
  std::atomic<int> checked{0};
  on_goal = [&](const rcl_cxx::GoalUUID &, const Fibonacci::Goal &) -> tl::expected<void, std::string> {
    ++checked;
    return {};
  };
  const auto goal = send(5);
  ASSERT_TRUE(goal);
  const auto handle = accepted(0);
  EXPECT_EQ(send_with_id(goal->get_goal_id()), false);
  EXPECT_EQ(checked, 1);
  EXPECT_THAT(discarded, IsEmpty());
  EXPECT_TRUE(handle->succeed());
  EXPECT_EQ(send_with_id(goal->get_goal_id()), false) << "its result is still kept";
  EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
}

TEST_F(GoalIdTest, CancelReachesTheFirstGoalAfterASecondOneWithItsIdWasRejected)
{
  serve();
  const auto goal = send(5);
  const auto handle = accepted(0);
  EXPECT_EQ(send_with_id(goal->get_goal_id()), false);
  EXPECT_EQ(get(goal->async_cancel()).code, CancelCode::none);
  EXPECT_TRUE(handle->is_canceling());
  EXPECT_TRUE(handle->canceled());
  EXPECT_EQ(result(goal).status, GoalStatus::canceled);
}

TEST_F(ActionGoalTest, RunsBesideOtherGoals)
{
  serve();
  std::vector<std::shared_ptr<rcl_cxx::ClientGoalHandle<Fibonacci>>> goals;
  for (int i = 0; i < 10; ++i) {
    goals.push_back(send(i));
    ASSERT_TRUE(goals.back());
  }
  accepted(9);
  for (std::size_t i = 10; i-- > 0;) {
    EXPECT_TRUE(accepted(i)->succeed(result_of({static_cast<int>(i)})));
  }
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_THAT(result(goals[i]).result.sequence, ElementsAre(static_cast<int>(i)));
  }
}

TEST_F(ActionGoalTest, SendsFeedbackToItsOwnClient)
{
  serve();
  std::atomic<int> first{0};
  std::atomic<int> second{0};
  rcl_cxx::SendGoalOptions<Fibonacci> options;
  options.feedback_callback = [&](const Fibonacci::Feedback & feedback) { first = feedback.sequence.at(0); };
  const auto one = send(1, options);
  options.feedback_callback = [&](const Fibonacci::Feedback & feedback) { second = feedback.sequence.at(0); };
  const auto two = send(2, options);
  Fibonacci::Feedback feedback;
  feedback.sequence = {42};
  EXPECT_TRUE(accepted(1)->publish_feedback(feedback));
  EXPECT_TRUE(eventually([&] { return second == 42; }));
  EXPECT_EQ(first, 0);
}

TEST_F(ActionServerTest, AbortsItsGoalsWhenDestroyed)
{
  serve();
  const auto goal = send(5);
  const auto handle = accepted(0);
  server.reset();
  EXPECT_FALSE(handle->is_active());
  EXPECT_FALSE(handle->succeed());
  EXPECT_FALSE(handle->publish_feedback(Fibonacci::Feedback()));
  EXPECT_EQ(result(goal).status, GoalStatus::aborted);
}

TEST_F(ActionServerTest, FillsMissingResult)
{
  on_missing_result = [](GoalStatus status, Fibonacci::Result & result) {
    result.sequence = {static_cast<int>(status), 7};
  };
  on_accepted = [](const std::shared_ptr<Handle> &) {};  // releases the handle
  serve();
  const auto end = result(send(5));
  EXPECT_EQ(end.status, GoalStatus::aborted);
  EXPECT_EQ(end.result.sequence, result_of({static_cast<int>(GoalStatus::aborted), 7}).sequence);
}

TEST_F(ActionServerTest, SendsResultOfJustAcceptedGoalWhenDestroyed)
{
  for (std::size_t round = 0; round < 10; ++round) {
    serve();
    auto response = client->async_send_goal(goal_of(5));
    accepted(round);
    server.reset();
    const auto goal = get(std::move(response));
    ASSERT_TRUE(goal);
    EXPECT_EQ(result(goal).status, GoalStatus::aborted);
  }
}

TEST_F(ActionServerTest, SendsResultOfGoalThatHasJustSucceededWhenDestroyed)
{
  for (std::size_t round = 0; round < 10; ++round) {
    serve();
    auto response = client->async_send_goal(goal_of(5));
    EXPECT_TRUE(accepted(round)->succeed(result_of({1})));
    server.reset();
    const auto goal = get(std::move(response));
    ASSERT_TRUE(goal);
    EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
  }
}

TEST_F(ActionServerTest, AbortsItsGoalsAfterPreShutdownCallbacks)
{
  serve();
  const auto goal = send(5);
  const auto other = send(6);
  const auto handle = accepted(0);
  const auto left = accepted(1);
  context->add_pre_shutdown_callback([&] { EXPECT_TRUE(handle->succeed(result_of({1}))); });
  context->shutdown("test");
  EXPECT_EQ(handle->get_status(), GoalStatus::succeeded);
  EXPECT_EQ(left->get_status(), GoalStatus::aborted);
  EXPECT_FALSE(left->abort());
}

TEST_F(ActionServerTest, RejectsGoalsDuringShutdown)
{
  serve();
  std::optional<bool> rejected;
  context->add_pre_shutdown_callback([&] { rejected = send(5) == nullptr; });
  context->shutdown("test");
  EXPECT_EQ(rejected, true);
}

TEST_F(ActionServerTest, ForgetsResultsAfterTimeout)
{
  rcl_cxx::ActionServerOptions options;
  options.result_timeout = std::chrono::seconds(2);
  serve(options);
  const auto goal = send(5);
  EXPECT_TRUE(accepted(0)->succeed());
  EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
  EXPECT_EQ(get(client->async_cancel_goal(goal->get_goal_id())).code, CancelCode::goal_terminated);
  EXPECT_TRUE(eventually(
      [&] { return get(client->async_cancel_goal(goal->get_goal_id())).code == CancelCode::unknown_goal; }));
}

TEST_F(ActionServerTest, SurvivesItsClientWhosePromisesBreak)
{
  serve();
  const auto goal = send(5);
  client.reset();
  EXPECT_THROW(goal->async_get_result().get(), std::future_error);
  EXPECT_THROW(goal->async_cancel(), rcl_cxx::Error);
  EXPECT_TRUE(accepted(0)->abort());
}

TEST_F(SendGoalTest, WaitsForResult)
{
  serve();
  on_accepted = [](std::shared_ptr<Handle> handle) {
    handle->publish_feedback(Fibonacci::Feedback());
    handle->succeed(result_of({handle->get_goal().order}));
  };
  const auto end = client->send_goal(goal_of(9), kLimit);
  ASSERT_TRUE(end) << end.error();
  EXPECT_EQ(end->status, GoalStatus::succeeded);
  EXPECT_THAT(end->result.sequence, ElementsAre(9));
}

TEST_F(SendGoalTest, ReportsWhatWentWrong)
{
  serve();
  on_goal = [](const rcl_cxx::GoalUUID &, const Fibonacci::Goal & goal) -> tl::expected<void, std::string> {
    return goal.order == 0 ? tl::make_unexpected(std::string("no")) : tl::expected<void, std::string>{};
  };
  EXPECT_THAT(client->send_goal(goal_of(0), kLimit).error(), HasSubstr("rejected"));
  EXPECT_THAT(client->send_goal(goal_of(1), std::chrono::seconds(2)).error(), HasSubstr("cancel requested"));
  const auto other = rcl_cxx::create_action_client<Fibonacci>(*node, "nobody");
  EXPECT_THAT(other->send_goal(goal_of(1), std::chrono::milliseconds(20)).error(),
              HasSubstr("no such action server"));
  std::promise<std::string> error;
  executor->post([&] { error.set_value(client->send_goal(goal_of(1), kLimit).error()); });
  EXPECT_THAT(get(error.get_future()), HasSubstr("never returns"));
}

TEST_F(SendGoalTest, CancelsGoalAtTimeout)
{
  serve();
  EXPECT_FALSE(client->send_goal(goal_of(1), std::chrono::milliseconds(100)));
  EXPECT_TRUE(eventually([&] { return accepted(0)->is_canceling(); }));
}
