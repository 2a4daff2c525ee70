#include <chrono>
#include <regex>
#include <stdexcept>

#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

bool wait_for_mode(SimulatedController & controller, const std::string & mode)
{
  return controller.wait_until([&](const json & state) { return state["robot_mode"] == mode; }, seconds(20));
}

constexpr const char * endless = "def endless():\n  while True:\n    sync()\n  end\nend\n";

class Dashboard : public SimulatorTest {
 protected:
  void store(const std::string & name, const std::string & script)
  {
    ASSERT_TRUE(controller.control({{"command", "store_program"}, {"name", name}, {"script", script}})["ok"]);
  }
  DashboardClient client{controller.address()};
};

TEST_F(Dashboard, greets_and_says_goodbye)
{
  EXPECT_EQ(client.greeting, "Connected: Universal Robots Dashboard Server");
  EXPECT_EQ(client.ask("quit"), "Disconnected");
  EXPECT_TRUE(client.socket().closed_by_peer());
}

// AddressSanitizer sees it if the client is used after that.
TEST_F(Dashboard, survives_a_client_that_is_gone_when_its_quit_is_answered)
{
  const auto stall = [&](bool stalled) {
    controller.control({{"command", "stall_links"}, {"which", "dashboard"}, {"stalled", stalled}});
  };
  stall(true);
  client.socket().send("quit\n");
  client.socket().reset();
  stall(false);
  DashboardClient next(controller.address());
  EXPECT_EQ(next.ask("quit"), "Disconnected");
}

TEST_F(Dashboard, answers_inquiries_as_the_manual_says)
{
  EXPECT_EQ(client.ask("robotmode"), "Robotmode: RUNNING");
  EXPECT_EQ(client.ask("safetymode"), "Safetymode: NORMAL");
  EXPECT_EQ(client.ask("safetystatus"), "Safetystatus: NORMAL");
  EXPECT_EQ(client.ask("running"), "Program running: false");
  EXPECT_EQ(client.ask("get loaded program"), "No program loaded");
  EXPECT_EQ(client.ask("is in remote control"), "true");
  EXPECT_EQ(client.ask("get robot model"), "UR10");
  EXPECT_EQ(client.ask("get operational mode"), "NONE");
  EXPECT_TRUE(std::regex_match(client.ask("get serial number"), std::regex("\\d+")));
  EXPECT_TRUE(std::regex_match(client.ask("PolyscopeVersion"),
                               std::regex("URSoftware \\d+\\.\\d+\\.\\d+\\.\\d+ .*")));
  EXPECT_EQ(client.ask("version"), "5.25.1.0");
}

TEST_F(Dashboard, understands_commands_in_any_case_and_with_carriage_returns)
{
  EXPECT_EQ(client.ask("ROBOTMODE\r"), "Robotmode: RUNNING");
  EXPECT_EQ(client.ask("polyscopeversion").substr(0, 10), "URSoftware");
}

TEST_F(Dashboard, does_not_understand_what_is_no_command)
{
  EXPECT_EQ(client.ask("dance"), "could not understand: 'dance'");
  EXPECT_EQ(client.ask(""), "could not understand: ''");
  EXPECT_EQ(client.ask("setUserRole operator"), "could not understand: 'setUserRole operator'");
}

TEST_F(Dashboard, answers_stop_also_when_nothing_runs)
{
  EXPECT_EQ(client.ask("stop"), "Stopped");
}

TEST_F(Dashboard, loads_plays_pauses_and_stops_a_program)
{
  store("endless.urp", endless);
  EXPECT_EQ(client.ask("load endless.urp"), "Loading program: endless.urp");
  EXPECT_EQ(client.ask("get loaded program"), "Loaded program: /programs/endless.urp");
  EXPECT_EQ(client.ask("play"), "Starting program");
  EXPECT_TRUE(wait_for_program(controller, "PLAYING"));
  EXPECT_EQ(client.ask("running"), "Program running: true");
  EXPECT_EQ(client.ask("programState"), "PLAYING endless.urp");
  EXPECT_EQ(client.ask("pause"), "Pausing program");
  EXPECT_TRUE(wait_for_program(controller, "PAUSED"));
  EXPECT_EQ(client.ask("programState"), "PAUSED endless.urp");
  EXPECT_EQ(client.ask("play"), "Starting program");
  EXPECT_TRUE(wait_for_program(controller, "PLAYING"));
  EXPECT_EQ(client.ask("stop"), "Stopped");
  EXPECT_TRUE(wait_for_program(controller, "STOPPED"));
}

TEST_F(Dashboard, refuses_programs_that_are_missing_or_broken)
{
  store("broken.urp", "def broken(:\n");
  EXPECT_EQ(client.ask("load missing.urp"), "File not found: missing.urp");
  EXPECT_EQ(client.ask("load broken.urp"), "Error while loading program: broken.urp");
  EXPECT_EQ(client.ask("play"), "Failed to execute: play");
  EXPECT_EQ(client.ask("pause"), "Failed to execute: pause");
}

TEST_F(Dashboard, powers_the_robot_off_and_on_and_releases_the_brakes)
{
  store("endless.urp", endless);
  client.ask("load endless.urp");
  EXPECT_EQ(client.ask("power off"), "Powering off");
  EXPECT_TRUE(wait_for_mode(controller, "POWER_OFF"));
  EXPECT_EQ(client.ask("play"), "Failed to execute: play");
  EXPECT_EQ(client.ask("power on"), "Powering on");
  EXPECT_TRUE(wait_for_mode(controller, "IDLE"));
  EXPECT_EQ(client.ask("brake release"), "Brake releasing");
  EXPECT_TRUE(wait_for_mode(controller, "RUNNING"));
}

TEST_F(Dashboard, unlocks_a_protective_stop_after_five_seconds_only)
{
  controller.control({{"command", "protective_stop"}});
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["safety_mode"] == "PROTECTIVE_STOP"; }, seconds(5)));
  EXPECT_EQ(client.ask("unlock protective stop").substr(0, 46),
            "Cannot unlock protective stop until 5s after o");
  const double since = controller.state()["timestamp"];
  ASSERT_TRUE(controller.wait_until(
      [&](const json & state) { return state["timestamp"].get<double>() > since + 5.1; }, seconds(30)));
  EXPECT_EQ(client.ask("unlock protective stop"), "Protective stop releasing");
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["safety_mode"] == "NORMAL"; }, seconds(5)));
}

TEST_F(Dashboard, shows_and_closes_popups)
{
  EXPECT_EQ(client.ask("popup mind the gap"), "showing popup");
  EXPECT_EQ(controller.state()["popup"], "mind the gap");
  EXPECT_EQ(client.ask("close popup"), "closing popup");
  EXPECT_TRUE(controller.state()["popup"].is_null());
}

TEST_F(Dashboard, adds_messages_to_the_log)
{
  EXPECT_EQ(client.ask("addToLog shift begins"), "Added log message");
  EXPECT_EQ(client.ask("addToLog"), "No log message to add");
  EXPECT_TRUE(logged(controller, "shift begins"));
}

TEST_F(Dashboard, in_local_control_only_answers_inquiries_until_switched_and_reconnected)
{
  controller.control({{"command", "remote_control"}, {"on", false}});
  EXPECT_EQ(client.ask("power off").substr(0, 44), "Command is not allowed due to safety reasons");
  EXPECT_EQ(client.ask("is in remote control"), "false");
  DashboardClient connected_in_local_control(controller.address());
  controller.control({{"command", "remote_control"}, {"on", true}});
  EXPECT_EQ(connected_in_local_control.ask("stop").substr(0, 22), "Command is not allowed");
  EXPECT_EQ(DashboardClient(controller.address()).ask("stop"), "Stopped");
}

TEST_F(Dashboard, survives_lines_without_end)
{
  client.socket().send(std::string(100000, 'x'));
  EXPECT_TRUE(client.socket().closed_by_peer());
  EXPECT_EQ(DashboardClient(controller.address()).ask("robotmode"), "Robotmode: RUNNING");
}

TEST_F(Dashboard, shutdown_switches_the_controller_off)
{
  EXPECT_EQ(client.ask("shutdown"), "Shutting down");
  EXPECT_TRUE(client.socket().closed_by_peer());
  const auto refused = [address = controller.address()] {
    try {
      RawSocket(address, 29999);
      return false;
    } catch (const std::runtime_error &) {
      return true;
    }
  };
  // The connections go first, the ports right after.
  EXPECT_TRUE(
      controller.wait_until([&](const nlohmann::json &) { return refused(); }, std::chrono::seconds(5)));
}

TEST(DashboardOfACb3, knows_user_roles_but_no_operational_modes)
{
  SimulatorOptions options;
  options.model = "ur5";
  SimulatedController controller(on_own_address(options));
  DashboardClient client(controller.address());
  EXPECT_EQ(client.ask("setUserRole operator"), "Setting user role: operator");
  EXPECT_EQ(client.ask("getUserRole"), "OPERATOR");
  EXPECT_EQ(client.ask("get operational mode"), "could not understand: 'get operational mode'");
  EXPECT_EQ(client.ask("get robot model"), "UR5");
}

}  // namespace
}  // namespace ur_simulator::testing
