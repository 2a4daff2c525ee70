#include "support/dashboard_client.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class FaultInjectionTest : public SimulatorTest {
 protected:
  json control(json request)
  {
    const json reply = controller.control(request);
    EXPECT_TRUE(reply["ok"]) << reply.dump();
    return reply;
  }
};

TEST_F(FaultInjectionTest, KillsProgramWithoutLogEntry)
{
  control({{"command", "run_script"}, {"script", "def gone():\n movej([0,-1,1,-1,1,0], v=0.3)\nend\n"}});
  ASSERT_TRUE(wait_until_moving(controller, seconds(5)));
  const json before = controller.control({{"command", "log"}})["entries"];
  control({{"command", "kill_program"}});
  EXPECT_EQ(controller.state()["program"]["state"], "STOPPED");
  EXPECT_EQ(controller.control({{"command", "log"}})["entries"].size(), before.size());
  EXPECT_TRUE(wait_until_at_rest(controller, seconds(5)));
  EXPECT_FALSE(controller.control({{"command", "kill_program"}})["ok"]);
}

TEST_F(FaultInjectionTest, DelaysDashboardRepliesAndKeepsOrder)
{
  DashboardClient client(controller.address());
  control({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 300}});
  const auto begin = std::chrono::steady_clock::now();
  client.socket().send("robotmode\nsafetymode\n");
  EXPECT_EQ(client.socket().receive_line(), "Robotmode: RUNNING");
  // The delay applies to the command and to the reply.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(600));
  EXPECT_EQ(client.socket().receive_line(), "Safetymode: NORMAL");
  control({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 0}});
  EXPECT_EQ(client.request("quit"), "Disconnected");
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(FaultInjectionTest, DropsDelayedConnection)
{
  DashboardClient client(controller.address());
  control({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 60000}});
  client.socket().send("robotmode\n");
  control({{"command", "drop_links"}, {"which", "dashboard"}});
  EXPECT_TRUE(client.socket().closed_by_peer());
}

/// A connection that waits until its peer reads, and is stalled and resumed before it notices either.
TEST_F(FaultInjectionTest, AStallThatEndsAtOnceDoesNotSilenceAConnection)
{
  SimulatorOptions options;
  options.real_time_factor = 50.0;
  SimulatedController fast(with_unique_address(options));
  RtdeClient idle(fast.address());
  ASSERT_TRUE(idle.negotiate(2));
  idle.setup_outputs(500.0, "timestamp,actual_q,actual_qd,actual_TCP_pose,target_q,target_qd,target_moment");
  ASSERT_TRUE(idle.start());
  const auto timestamp = [&] { return fast.state()["timestamp"].get<double>(); };
  const double full = timestamp() + 60.0;  // 9 MB, more than the buffers of both ends
  ASSERT_TRUE(fast.wait_until([&](const json & state) { return state["timestamp"].get<double>() > full; },
                              seconds(60)));
  TcpClient control_port(fast.address(), fast.ports().control);
  control_port.send(
      "{\"command\": \"stall_links\", \"which\": \"rtde\"}\n"
      "{\"command\": \"stall_links\", \"which\": \"rtde\", \"stalled\": false}\n");
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(json::parse(control_port.receive_line())["ok"]);
  }
  const double resumed = timestamp();
  while (decode_double(idle.receive('U').payload.substr(1, 8)) <= resumed) {
  }
}

TEST_F(FaultInjectionTest, LosesCommands)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  ASSERT_EQ(client.setup_inputs("input_int_register_20")[0], 1);
  ASSERT_TRUE(client.start());
  control({{"command", "lose_commands"}, {"which", "rtde"}, {"count", 1}});
  const auto register_is = [&](int value) {
    return controller.control({{"command", "registers"}})["inputs"]["integers"][20] == value;
  };
  client.send('U', data_package_header(1) + encode_int32(5));
  // The package is read, and discarded, within the following cycles.
  control({{"command", "state"}});
  ASSERT_TRUE(wait_simulated_time(controller, 0.1, seconds(5)));
  EXPECT_TRUE(register_is(0));
  client.send('U', data_package_header(1) + encode_int32(6));
  bool arrived = false;
  for (int i = 0; i < 100 && !arrived; ++i) {
    wait_for_next_cycle(controller);
    arrived = register_is(6);
  }
  EXPECT_TRUE(arrived);
}

}  // namespace
}  // namespace ur_simulator::testing
