#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <rcl_cxx/executor.hpp>
#include <rcl_cxx_test/action_client.hpp>
#include <string>
#include <thread>
#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde::test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Trigger = ur_ros_rtde_msgs::action::Trigger;

inline rcl_cxx::Context::SharedPtr make_context(const std::string & name)
{
  return std::make_shared<rcl_cxx::Context>(std::vector<std::string>{name},
                                            rcl_cxx::InitOptions{.shutdown_on_signal = false});
}

/// Executors that spin in threads of their own until the object is destroyed.
class Spinning {
 public:
  explicit Spinning(rcl_cxx::Node & node, const rcl_cxx::CallbackGroup * group = nullptr)
      : nodes_(node.get_context()), groups_(node.get_context())
  {
    nodes_.add_node(node);
    threads_.emplace_back([this] { nodes_.spin(); });
    if (group != nullptr) {
      groups_.add_callback_group(*group);
      threads_.emplace_back([this] { groups_.spin(); });
    }
  }
  ~Spinning()
  {
    nodes_.cancel();
    groups_.cancel();
  }

 private:
  rcl_cxx::Executor nodes_, groups_;
  std::vector<std::jthread> threads_;
};

/// What a goal of a test does, by default nothing.
struct Behavior {
  using Result = Trigger::Result;
  std::function<Status(std::vector<GoalQuery> &)> check = [](std::vector<GoalQuery> &) { return Status(); };
  std::function<Outcome(const StopRequest &)> execute = [](const StopRequest &) {
    return Outcome::success();
  };
  std::function<void(const Outcome &, Trigger::Result &)> fill_result =
      [](const Outcome & outcome, Trigger::Result & result) { write_standard_fields(outcome, result); };
  std::function<std::optional<Error>()> ended_by_robot = [] { return std::nullopt; };
  std::function<std::optional<Status>()> stopped = [] { return Status(); };
  std::function<void()> release = [] {};
};

class BehavingGoal : public Goal {
 public:
  BehavingGoal(PluginHost & host, const rcl_cxx::GoalUUID & id, const Behavior & behavior)
      : Goal(host, "/test", id), behavior_(behavior)
  {
  }

  Status check(std::vector<GoalQuery> & queries) override { return behavior_.check(queries); }
  void release() override { behavior_.release(); }
  std::optional<Error> ended_by_robot() const override { return behavior_.ended_by_robot(); }
  std::optional<Status> stopped() const override { return behavior_.stopped(); }

 private:
  Outcome execute() override { return behavior_.execute(stop_request()); }
  void send_result(const Outcome & outcome, bool) override
  {
    Trigger::Result result;
    send(write_outcome(behavior_, outcome, result), &result);
  }

  const Behavior & behavior_;
};

/// The server of an action with goals that behave as the test says, and a client of it.
class GoalTest : public testing::Test {
 protected:
  ~GoalTest() override { host_.goals().close(Error{ErrorCode::shutdown, "the test ends"}, seconds(10)); }

  /// `on_client_lost`: empty if goals go on without their client.
  void serve(std::function<void(const rcl_cxx::GoalUUID &)> on_client_lost = {})
  {
    server_ = std::make_unique<GoalServer>(
        host_, GoalServer::Description{rcl_cxx::action_type<Trigger>(), "test", std::move(on_client_lost)},
        [this](const rcl_cxx::GoalUUID & id, const void *) {
          goal_ = std::make_shared<BehavingGoal>(host_, id, behavior_);
          return goal_;
        },
        make_missing_results(behavior_));
  }
  auto send()
  {
    EXPECT_TRUE(client_->wait_for_action_server(seconds(20)));
    return client_->send_goal(Trigger::Goal(), seconds(20));
  }
  /// Whether a goal of another action, which is a stop, succeeds.
  bool stops()
  {
    stop_server_ = std::make_unique<GoalServer>(
        host_, GoalServer::Description{rcl_cxx::action_type<Trigger>(), "stop", {}, true},
        [this](const rcl_cxx::GoalUUID & id, const void *) {
          return std::make_shared<BehavingGoal>(host_, id, stop_behavior_);
        },
        make_missing_results(stop_behavior_));
    const auto client = rcl_cxx::create_action_client<Trigger>(node_, "stop");
    EXPECT_TRUE(client->wait_for_action_server(seconds(20)));
    return client->send_goal(Trigger::Goal(), seconds(20)).has_value();
  }
  std::shared_ptr<rcl_cxx::ClientGoalHandle<Trigger>> send_and_go_on()
  {
    EXPECT_TRUE(client_->wait_for_action_server(seconds(20)));
    auto response = client_->async_send_goal(Trigger::Goal());
    return response.wait_for(seconds(20)) == std::future_status::ready ? response.get() : nullptr;
  }
  static rcl_cxx::WrappedResult<Trigger> result(
      const std::shared_ptr<rcl_cxx::ClientGoalHandle<Trigger>> & goal)
  {
    auto end = goal->async_get_result();
    EXPECT_EQ(end.wait_for(seconds(20)), std::future_status::ready);
    return end.get();
  }
  /// Waits until the goal is told to end.
  static Outcome until_told(const StopRequest & stop_request)
  {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    wake.wait_for(lock, stop_request.token(), seconds(20), [] { return false; });
    const auto why = stop_request.reason();
    return why ? Outcome(*why) : Outcome::success();
  }

  rcl_cxx::Context::SharedPtr context_ = make_context("test_goals");
  rcl_cxx::Node node_{context_, "test_goals"};
  PluginHost host_{node_};
  Behavior behavior_, stop_behavior_;
  std::shared_ptr<Goal> goal_;  ///< the newest
  Spinning spinning_{node_, host_.stop_group().get()};
  std::unique_ptr<GoalServer> server_, stop_server_;
  std::shared_ptr<rcl_cxx::ActionClient<Trigger>> client_ =
      rcl_cxx::create_action_client<Trigger>(node_, "test");
};

}  // namespace ur_ros_rtde::test
