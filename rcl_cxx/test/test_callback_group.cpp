#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <rcl_cxx_test/client.hpp>
#include <test_msgs/msg/empty.hpp>
#include <test_msgs/srv/empty.hpp>
#include <thread>

#include "action_fixture.hpp"

namespace {
/// An action server whose cancel requests have a group of their own, in a thread of their own.
class CallbackGroupTest : public Actions {
 protected:
  ~CallbackGroupTest() override
  {
    second.cancel();
    thread.join();
  }

  void serve_with_group()
  {
    rcl_cxx::ActionServerOptions options;
    options.cancel_callback_group = group;
    serve(options);
  }

  /// Its callback runs until ends_ is set.
  auto send_one_that_blocks(int order)
  {
    std::promise<void> begins;
    on_goal = [&](const rcl_cxx::GoalUUID &, const Fibonacci::Goal &) {
      begins.set_value();
      ends_.get_future().wait();
      return rcl_cxx::GoalResponse{};
    };
    auto response = client->async_send_goal(goal_of(order), {});
    EXPECT_EQ(begins.get_future().wait_for(kLimit), std::future_status::ready);
    return response;
  }

  std::promise<void> ends_;
  rcl_cxx::CallbackGroup::SharedPtr group = node->create_callback_group();
  rcl_cxx::Executor second{context};
  std::thread thread{[this] {
    second.add_callback_group(*group);
    second.spin();
  }};
};
}  // namespace

TEST_F(CallbackGroupTest, CancelOfAllGoalsReachesOneThatIsBeingChecked)
{
  serve_with_group();
  const auto running = send(1);
  std::promise<void> canceled;
  on_cancel = [&](Handle &) {
    canceled.set_value();
    return true;
  };
  std::promise<void> checked;
  on_goal = [&](const rcl_cxx::GoalUUID &, const Fibonacci::Goal &) -> rcl_cxx::GoalResponse {
    checked.set_value();
    EXPECT_EQ(canceled.get_future().wait_for(kLimit), std::future_status::ready);
    return {};
  };
  auto response = client->async_send_goal(goal_of(2), {});
  get(checked.get_future());
  auto cancel = client->async_cancel_all_goals();
  EXPECT_FALSE(get(std::move(response))) << "it was canceled before it was accepted";
  EXPECT_EQ(get(std::move(cancel)).goals.size(), 1U);
  EXPECT_TRUE(accepted(0)->canceled());
}

TEST_F(CallbackGroupTest, MessagesDoNotWaitForTheCallbackOfAGoalRequest)
{
  serve_with_group();
  std::atomic<int> received{0};
  const auto subscription = node->create_subscription<test_msgs::msg::Empty>(
      "messages", rcl_cxx::QoS::services_default(), [&](const test_msgs::msg::Empty &) { ++received; },
      group);
  const auto publisher =
      node->create_publisher<test_msgs::msg::Empty>("messages", rcl_cxx::QoS::services_default());
  auto response = send_one_that_blocks(1);
  EXPECT_TRUE(eventually([&] {
    publisher->publish(test_msgs::msg::Empty());
    return received > 0;
  }));
  ends_.set_value();
  EXPECT_TRUE(get(std::move(response)));
}

TEST_F(CallbackGroupTest, ServicesAndTimersDoNotWaitForTheCallbackOfAGoalRequest)
{
  using Empty = test_msgs::srv::Empty;
  serve_with_group();
  std::atomic<int> requests{0};
  std::atomic<int> ticks{0};
  const auto service = node->create_service<Empty>(
      "empty", [&](const Empty::Request &, Empty::Response &) { ++requests; },
      rcl_cxx::QoS::services_default(), group);
  const auto timer = node->create_wall_timer(std::chrono::milliseconds(1), [&] { ++ticks; }, group);
  const auto service_client = rcl_cxx::create_client<Empty>(*node, "empty");
  ASSERT_TRUE(service_client->wait_for_service(kLimit));
  auto response = send_one_that_blocks(1);
  const int before = ticks;
  service_client->async_send_request({}, [](const Empty::Response &) {});
  EXPECT_TRUE(eventually([&] { return requests > 0 && ticks > before; }));
  ends_.set_value();
  EXPECT_TRUE(get(std::move(response)));
}

TEST_F(CallbackGroupTest, CancelRequestsDoNotWaitForTheCallbackOfAGoalRequest)
{
  serve_with_group();
  std::atomic<bool> canceled{false};
  on_cancel = [&](Handle &) {
    canceled = true;
    return true;
  };
  const auto goal = send(1);
  const auto handle = accepted(0);
  auto response = send_one_that_blocks(2);
  auto cancel = goal->async_cancel();
  EXPECT_TRUE(eventually([&] { return canceled && handle->is_canceling(); }));
  ends_.set_value();
  EXPECT_EQ(get(std::move(cancel)).code, CancelCode::none);
  EXPECT_TRUE(handle->canceled(result_of({1})));
  EXPECT_TRUE(get(std::move(response)));
}

TEST_F(CallbackGroupTest, GoalsAreServedFromBeginningToEnd)
{
  serve_with_group();
  for (int i = 0; i < 20; ++i) {
    const auto goal = send(i);
    ASSERT_TRUE(goal);
    EXPECT_TRUE(accepted(static_cast<std::size_t>(i))->succeed(result_of({i})));
    EXPECT_EQ(result(goal).status, GoalStatus::succeeded);
  }
}

TEST_F(CallbackGroupTest, AServerCanBeDestroyedWhileRequestsArrive)
{
  serve_with_group();
  for (int i = 0; i < 10; ++i) {
    const auto goal = send(i);
    ASSERT_TRUE(goal);
    auto cancel = goal->async_cancel();
    server.reset();
    handles.clear();
    serve_with_group();
  }
}

TEST_F(CallbackGroupTest, BelongsToOneExecutor)
{
  rcl_cxx::Executor third{context};
  const auto own = node->create_callback_group();
  third.add_callback_group(*own);
  EXPECT_THROW(third.add_callback_group(*own), rcl_cxx::Error);
}
