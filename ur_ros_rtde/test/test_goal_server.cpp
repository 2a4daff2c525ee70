// What a plugin throws outside of run() ends its goal, not the process.
#include <gtest/gtest.h>

#include <rcl_cxx/executor.hpp>
#include <rcl_cxx_test/action_client.hpp>
#include <thread>
#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "ur_ros_rtde/detail/command_executor.hpp"
#include "ur_ros_rtde/detail/goal_server.hpp"
#include "ur_ros_rtde_robot/robot.hpp"

namespace ur_ros_rtde {
namespace {
using rcl_cxx::GoalUUID;
using ur_ros_rtde_msgs::action::Trigger;

class GoalServerTest : public testing::Test {
 protected:
  rcl_cxx::Context::SharedPtr context_ = std::make_shared<rcl_cxx::Context>(
      std::vector<std::string>{"test_goal_server"}, rcl_cxx::InitOptions{.shutdown_on_signal = false});
  rcl_cxx::Node node_{context_, "test_goal_server"};
};

/// An action whose result cannot be filled in.
class FaultyServer : public GoalServer {
 public:
  FaultyServer(rcl_cxx::Node & node, PluginHost & host) : active_goals_(host, "/faulty")
  {
    start_server(node, rcl_cxx::action_type<Trigger>(), "faulty", active_goals_, false);
  }
  ~FaultyServer() override { stop_server(); }

 private:
  rcl_cxx::GoalDecision accept_goal(const GoalUUID & id, const void *) override
  {
    return active_goals_.accept(id, [](GoalContext &) { return Status(); });
  }
  void execute_goal(Handle & handle, GoalContext &) override
  {
    abort_unstarted(handle, Outcome::success("done"));
  }
  void abort_unstarted(Handle & handle, const Outcome & outcome) override
  {
    Trigger::Result result;
    finish(handle, &result, outcome);
  }
  void write_outcome(const Outcome &, void *) const override
  {
    throw std::runtime_error("a fault in fill_result");
  }
  void write_failure(const Outcome & outcome, void * result) const override
  {
    write_standard_fields(outcome, *static_cast<Trigger::Result *>(result));
  }

  ActiveGoals active_goals_;
};

TEST_F(GoalServerTest, ExceptionInFillResultAbortsTheGoal)
{
  PluginHost host(node_);
  FaultyServer server(node_, host);
  const auto client = rcl_cxx::create_action_client<Trigger>(node_, "faulty");
  rcl_cxx::Executor executor(context_);
  executor.add_node(node_);
  std::jthread spinning([&executor] { executor.spin(); });
  const auto end = client->send_goal(Trigger::Goal(), std::chrono::seconds(20));
  executor.cancel();
  ASSERT_TRUE(end) << end.error();
  EXPECT_EQ(end->status, rcl_cxx::GoalStatus::aborted);
  EXPECT_FALSE(end->result.success);
  EXPECT_EQ(end->result.error_code, static_cast<std::uint16_t>(ErrorCode::exception));
  EXPECT_NE(end->result.message.find("a fault in fill_result"), std::string::npos) << end->result.message;
}

TEST_F(GoalServerTest, ExceptionInStopOptionsFailsTheGoalBeforeRun)
{
  RobotOptions options;
  options.address = "127.0.0.1";
  Robot robot(options, [](LogLevel, const std::string &) {});
  CommandHost host(node_, robot, {});
  CommandExecutor goals(host, "/faulty", CommandTraits{.resource = Resource::none}, "");
  GoalContext context;
  bool ran = false;
  const Outcome outcome = goals.execute(
      GoalUUID::random(), context,
      []() -> StopOptions { throw std::runtime_error("a fault in stop_options"); },
      [&ran] {
        ran = true;
        return Outcome::success();
      });
  EXPECT_FALSE(ran);
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
  EXPECT_NE(outcome.message().find("a fault in stop_options"), std::string::npos) << outcome.message();
}

}  // namespace
}  // namespace ur_ros_rtde
