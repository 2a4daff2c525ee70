#include <gtest/gtest.h>

#include <rcl_cxx/executor.hpp>
#include <rcl_cxx_test/action_client.hpp>
#include <ur_ros_rtde_msgs/action/trigger.hpp>

#include "ur_ros_rtde/detail/goal_server.hpp"

namespace ur_ros_rtde {
namespace {
using Trigger = ur_ros_rtde_msgs::action::Trigger;
using std::chrono::seconds;

rcl_cxx::Context::SharedPtr make_context()
{
  return std::make_shared<rcl_cxx::Context>(std::vector<std::string>{"test_goal_server_client"},
                                            rcl_cxx::InitOptions{.shutdown_on_signal = false});
}

/// A node whose executor spins in a thread, with a participant of its own as another process has it.
struct SpinningNode {
  explicit SpinningNode(const std::string & name) : node(context, name)
  {
    executor.add_node(rcl_cxx::Node::SharedPtr(&node, [](rcl_cxx::Node *) {}));
    thread = std::thread([this] { executor.spin(); });
  }
  ~SpinningNode()
  {
    context->shutdown("end of the test");
    thread.join();
  }

  rcl_cxx::Context::SharedPtr context = make_context();
  rcl_cxx::Node node;
  rcl_cxx::Executor executor{context};
  std::thread thread;
};

/// Goals that go on until they have to end.
class EndlessCommand : public GoalServer {
 public:
  EndlessCommand(rcl_cxx::Node & node, bool stop_when_client_lost)
      : host_(node), active_goals_(host_, "/endless")
  {
    start_server(node, rcl_cxx::action_type<Trigger>(), "endless", active_goals_, stop_when_client_lost);
  }
  ~EndlessCommand() override
  {
    host_.goal_threads().close(Error{ErrorCode::shutdown, ""}, seconds(10));
    stop_server();
  }

  std::promise<void> started;
  std::promise<ErrorCode> ended;

 private:
  rcl_cxx::GoalDecision accept_goal(const rcl_cxx::GoalUUID & id, const void *) override
  {
    return active_goals_.accept(id, [](GoalContext &) { return Status(); });
  }
  void execute_goal(Handle & handle, GoalContext & context) override
  {
    started.set_value();
    const auto limit = std::chrono::steady_clock::now() + seconds(10);
    while (!context.stop_request->reason() && std::chrono::steady_clock::now() < limit) {
      std::this_thread::yield();
    }
    const auto why = context.stop_request->reason();
    Trigger::Result result;
    finish(handle, &result, why ? Outcome(*why) : Outcome::success());
    ended.set_value(static_cast<ErrorCode>(result.error_code));
  }
  void abort_unstarted(Handle & handle, const Outcome & outcome) override
  {
    Trigger::Result result;
    finish(handle, &result, outcome);
  }

  void write_outcome(const Outcome & outcome, void * result) const override
  {
    write_standard_fields(outcome, *static_cast<Trigger::Result *>(result));
  }
  void write_failure(const Outcome & outcome, void * result) const override
  {
    write_outcome(outcome, result);
  }

  PluginHost host_;
  ActiveGoals active_goals_;
};

class GoalServerClientTest : public testing::Test {
 protected:
  /// How a goal ends whose client disappears, or the end of the node if it does not end before.
  static ErrorCode end_without_client(bool stop_when_client_lost)
  {
    auto ended = std::future<ErrorCode>();
    {
      SpinningNode server("server");
      EndlessCommand command(server.node, stop_when_client_lost);
      ended = command.ended.get_future();
      {
        SpinningNode other("client");
        const auto client = rcl_cxx::create_action_client<Trigger>(other.node, "endless");
        EXPECT_TRUE(client->wait_for_action_server(seconds(10)));
        const auto response = client->async_send_goal(Trigger::Goal());
        EXPECT_EQ(command.started.get_future().wait_for(seconds(10)), std::future_status::ready);
      }
      if (stop_when_client_lost) {
        EXPECT_EQ(ended.wait_for(seconds(5)), std::future_status::ready);
      } else {
        EXPECT_EQ(ended.wait_for(seconds(2)), std::future_status::timeout);
      }
    }
    return ended.get();
  }
};

TEST_F(GoalServerClientTest, StopsTheGoalOfALostClient)
{
  EXPECT_EQ(end_without_client(true), ErrorCode::client_lost);
}

TEST_F(GoalServerClientTest, ContinuesWithoutTheClientIfConfigured)
{
  EXPECT_EQ(end_without_client(false), ErrorCode::shutdown);
}
}  // namespace
}  // namespace ur_ros_rtde
