#include "support/dashboard_client.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class FaultsOnDemand : public SimulatorTest {
 protected:
  json command(json request)
  {
    const json reply = controller.control(request);
    EXPECT_TRUE(reply["ok"]) << reply.dump();
    return reply;
  }
};

TEST_F(FaultsOnDemand, a_program_is_killed_and_nothing_says_so)
{
  command({{"command", "run_script"}, {"script", "def gone():\n movej([0,-1,1,-1,1,0], v=0.3)\nend\n"}});
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return !state["at_rest"].get<bool>(); }, seconds(5)));
  const json before = controller.control({{"command", "log"}})["entries"];
  command({{"command", "kill_program"}});
  EXPECT_EQ(controller.state()["program"]["state"], "STOPPED");
  EXPECT_EQ(controller.control({{"command", "log"}})["entries"].size(), before.size());
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["at_rest"].get<bool>(); }, seconds(5)));
  EXPECT_FALSE(controller.control({{"command", "kill_program"}})["ok"]);
}

TEST_F(FaultsOnDemand, answers_of_the_dashboard_come_late_and_in_order)
{
  DashboardClient client(controller.address());
  command({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 300}});
  const auto begin = std::chrono::steady_clock::now();
  client.socket().send("robotmode\nsafetymode\n");
  EXPECT_EQ(client.socket().receive_line(), "Robotmode: RUNNING");
  // Both ways.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(600));
  EXPECT_EQ(client.socket().receive_line(), "Safetymode: NORMAL");
  command({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 0}});
  EXPECT_EQ(client.ask("quit"), "Disconnected");
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(FaultsOnDemand, a_delayed_connection_can_be_dropped)
{
  DashboardClient client(controller.address());
  command({{"command", "delay_links"}, {"which", "dashboard"}, {"ms", 60000}});
  client.socket().send("robotmode\n");
  command({{"command", "drop_links"}, {"which", "dashboard"}});
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(FaultsOnDemand, commands_are_lost)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  ASSERT_EQ(client.inputs("input_int_register_20")[0], 1);
  ASSERT_TRUE(client.start());
  command({{"command", "lose_commands"}, {"which", "rtde"}, {"count", 1}});
  const auto register_is = [&](int value) {
    return controller.control({{"command", "registers"}})["inputs"]["integers"][20] == value;
  };
  client.send('U', package_for(1) + int32(5));
  // The reply shows that what was sent before it has been taken, and lost.
  command({{"command", "state"}});
  const double since = controller.state()["timestamp"];
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["timestamp"].get<double>() > since + 0.1; }, seconds(5)));
  EXPECT_TRUE(register_is(0));
  client.send('U', package_for(1) + int32(6));
  bool arrived = false;
  for (int i = 0; i < 100 && !arrived; ++i) {
    const int cycle = controller.state()["cycle"];
    controller.wait_until([&](const json & state) { return state["cycle"].get<int>() > cycle; }, seconds(1));
    arrived = register_is(6);
  }
  EXPECT_TRUE(arrived);
}

}  // namespace
}  // namespace ur_simulator::testing
