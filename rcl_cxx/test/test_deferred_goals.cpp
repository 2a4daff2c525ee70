#include <gtest/gtest.h>

#include <mutex>
#include <optional>

#include "action_fixture.hpp"

/// A server that defers the response to each goal; the test sends it.
class DeferredGoalTest : public Actions {
 protected:
  DeferredGoalTest()
  {
    on_goal = [this](const rcl_cxx::GoalUUID &, const Fibonacci::Goal &) -> rcl_cxx::GoalDecision {
      return rcl_cxx::DeferredGoalResponse{[this](rcl_cxx::SendGoalResponse send) {
        const std::lock_guard lock(mutex);
        responders.push_back(std::move(send));
      }};
    };
  }

  using Response = std::future<std::shared_ptr<rcl_cxx::ClientGoalHandle<Fibonacci>>>;

  /// Sends a goal and returns when the server has deferred its response.
  Response send_deferred()
  {
    const std::size_t before = responder_count();
    Response response = client->async_send_goal(goal_of(5), {});
    EXPECT_TRUE(eventually([&] { return responder_count() == before + 1; }));
    return response;
  }

  std::size_t responder_count()
  {
    const std::lock_guard lock(mutex);
    return responders.size();
  }

  std::vector<rcl_cxx::SendGoalResponse> responders;
};

TEST_F(DeferredGoalTest, IsAcceptedByAResponseFromAnotherThread)
{
  serve();
  Response response = send_deferred();
  EXPECT_EQ(response.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  std::thread([&] { responders.at(0)({}); }).join();
  const auto goal = get(std::move(response));
  ASSERT_TRUE(goal);
  EXPECT_TRUE(accepted(0)->succeed(result_of({1})));
  EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
}

TEST_F(DeferredGoalTest, IsRejectedByItsResponse)
{
  serve();
  Response response = send_deferred();
  responders.at(0)(tl::unexpected<std::string>("unreachable"));
  EXPECT_FALSE(get(std::move(response)));
}

TEST_F(DeferredGoalTest, LetsTheServerAnswerOtherRequests)
{
  serve();
  Response first = send_deferred();
  Response second = send_deferred();
  responders.at(1)({});
  EXPECT_TRUE(get(std::move(second)));
  EXPECT_EQ(first.wait_for(std::chrono::milliseconds(0)), std::future_status::timeout);
  responders.at(0)({});
  EXPECT_TRUE(get(std::move(first)));
  accepted(0)->succeed();
  accepted(1)->succeed();
}

TEST_F(DeferredGoalTest, IsNotReplacedByAGoalWithTheSameId)
{
  serve();
  const auto defer = on_goal;
  std::optional<rcl_cxx::GoalUUID> id;
  on_goal = [&](const rcl_cxx::GoalUUID & goal_id, const Fibonacci::Goal & goal) {
    id = goal_id;
    return defer(goal_id, goal);
  };
  Response response = send_deferred();
  EXPECT_EQ(send_with_id(id.value()), false);
  EXPECT_EQ(responder_count(), 1U);
  responders.at(0)({});
  EXPECT_TRUE(get(std::move(response)));
  accepted(0)->succeed();
}

TEST_F(DeferredGoalTest, TakesTheFirstResponse)
{
  serve();
  Response response = send_deferred();
  responders.at(0)({});
  responders.at(0)(tl::unexpected<std::string>("too late"));
  EXPECT_TRUE(get(std::move(response)));
  accepted(0)->succeed();
}

TEST_F(DeferredGoalTest, IsRejectedWhenItsResponderIsDestroyed)
{
  serve();
  Response response = send_deferred();
  {
    const std::lock_guard lock(mutex);
    responders.clear();
  }
  EXPECT_FALSE(get(std::move(response)));
}

TEST_F(DeferredGoalTest, IsRejectedAfterARequestToCancelAllGoals)
{
  serve();
  Response response = send_deferred();
  get(client->async_cancel_all_goals());
  responders.at(0)({});
  EXPECT_FALSE(get(std::move(response)));
  EXPECT_EQ(discarded.size(), 1U);
  EXPECT_TRUE(handles.empty());
}

TEST_F(DeferredGoalTest, IsRejectedWhenTheServerIsDestroyed)
{
  serve();
  Response response = send_deferred();
  server.reset();
  EXPECT_FALSE(get(std::move(response)));
  responders.at(0)({});  // has no effect
}
