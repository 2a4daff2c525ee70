#pragma once

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <test_msgs/action/fibonacci.hpp>
#include <vector>

#include "rcl_cxx/rcl_cxx.hpp"
#include "rcl_cxx_test/action_client.hpp"
#include "rcl_cxx_test/action_server.hpp"
#include "rcl_cxx_test/client.hpp"
#include "ros_fixture.hpp"

using Fibonacci = test_msgs::action::Fibonacci;
using Handle = rcl_cxx::TypedGoalHandle<Fibonacci>;
using rcl_cxx::CancelCode;
using rcl_cxx::GoalStatus;

inline Fibonacci::Goal goal_of(int order)
{
  Fibonacci::Goal goal;
  goal.order = order;
  return goal;
}

inline Fibonacci::Result result_of(std::vector<int> sequence)
{
  Fibonacci::Result result;
  result.sequence.assign(sequence.begin(), sequence.end());
  return result;
}

/// A server that keeps the goal handles; the test finishes the goals.
class Actions : public Spinning {
 protected:
  ~Actions() override { context->shutdown("end of the test"); }

  void serve(const rcl_cxx::ActionServerOptions & options = {})
  {
    rcl_cxx::TypedCallbacks<Fibonacci> handlers;
    handlers.handle_goal = [this](const rcl_cxx::GoalUUID & id, const Fibonacci::Goal & goal) {
      return on_goal ? on_goal(id, goal) : rcl_cxx::GoalResponse{};
    };
    handlers.handle_accepted = [this](std::shared_ptr<Handle> handle) {
      if (on_accepted) {
        on_accepted(std::move(handle));
        return;
      }
      const std::lock_guard lock(mutex);
      handles.push_back(std::move(handle));
    };
    handlers.handle_cancel = [this](Handle & handle) { return !on_cancel || on_cancel(handle); };
    handlers.on_client_lost = [this](Handle & handle) {
      const std::lock_guard lock(mutex);
      without_client.push_back(handle.get_goal_id());
    };
    handlers.on_goal_discarded = [this](const rcl_cxx::GoalUUID & id) {
      const std::lock_guard lock(mutex);
      discarded.push_back(id);
    };
    handlers.fill_missing_result = on_missing_result;
    server = rcl_cxx::create_action_server<Fibonacci>(*node, "fibonacci", std::move(handlers), options);
    client = rcl_cxx::create_action_client<Fibonacci>(*node, "fibonacci");
    ASSERT_TRUE(client->wait_for_action_server(kLimit));
  }

  std::shared_ptr<rcl_cxx::ClientGoalHandle<Fibonacci>> send(int order,
                                                             rcl_cxx::SendGoalOptions<Fibonacci> options = {})
  {
    auto response = client->async_send_goal(goal_of(order), std::move(options));
    return response.wait_for(kLimit) == std::future_status::ready ? response.get() : nullptr;
  }

  /// Sends a goal with this id, as another client may do. Returns whether it was
  /// accepted.
  std::optional<bool> send_with_id(const rcl_cxx::GoalUUID & id)
  {
    using SendGoal = Fibonacci::Impl::SendGoalService;
    const auto service = rcl_cxx::create_client<SendGoal>(*node, "fibonacci/_action/send_goal");
    EXPECT_TRUE(service->wait_for_service(kLimit));
    SendGoal::Request request;
    request.goal_id.uuid = id.bytes;
    const auto response = service->call(request, kLimit);
    EXPECT_TRUE(response) << response.error();
    return response ? std::optional<bool>(response->accepted) : std::nullopt;
  }

  /// The server's handle of the n-th goal.
  std::shared_ptr<Handle> accepted(std::size_t n)
  {
    EXPECT_TRUE(eventually([&] {
      const std::lock_guard lock(mutex);
      return handles.size() > n;
    }));
    const std::lock_guard lock(mutex);
    return handles.at(n);
  }

  static rcl_cxx::WrappedResult<Fibonacci> result(
      const std::shared_ptr<rcl_cxx::ClientGoalHandle<Fibonacci>> & goal)
  {
    const bool ready = goal->async_get_result().wait_for(kLimit) == std::future_status::ready;
    EXPECT_TRUE(ready);
    return ready ? goal->async_get_result().get() : rcl_cxx::WrappedResult<Fibonacci>();
  }

  template <typename T>
  static T get(std::future<T> future)
  {
    EXPECT_EQ(future.wait_for(kLimit), std::future_status::ready);
    return future.get();
  }

  std::mutex mutex;
  std::vector<std::shared_ptr<Handle>> handles;
  std::vector<rcl_cxx::GoalUUID> without_client;
  std::vector<rcl_cxx::GoalUUID> discarded;
  std::function<rcl_cxx::GoalDecision(const rcl_cxx::GoalUUID &, const Fibonacci::Goal &)> on_goal;
  std::function<void(std::shared_ptr<Handle>)> on_accepted;
  std::function<bool(Handle &)> on_cancel;
  std::function<void(GoalStatus, Fibonacci::Result &)> on_missing_result;
  rcl_cxx::ActionServer::SharedPtr server;
  std::shared_ptr<rcl_cxx::ActionClient<Fibonacci>> client;
};
