#include <chrono>
#include <regex>
#include <stdexcept>

#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr const char * endless_program = "def endless():\n  while True:\n    sync()\n  end\nend\n";

class DashboardTest : public SimulatorTest {
 protected:
  void store_program(const std::string & name, const std::string & script)
  {
    ASSERT_TRUE(controller.control({{"command", "store_program"}, {"name", name}, {"script", script}})["ok"]);
  }
  DashboardClient client{controller.address()};
};

TEST_F(DashboardTest, SendsGreetingAndQuits)
{
  EXPECT_EQ(client.greeting, "Connected: Universal Robots Dashboard Server");
  EXPECT_EQ(client.request("quit"), "Disconnected");
  EXPECT_TRUE(client.socket().closed_by_peer());
}

// AddressSanitizer detects a use of the client after the reply.
TEST_F(DashboardTest, HandlesClientThatDisconnectsBeforeReply)
{
  const auto set_stalled = [&](bool stalled) {
    controller.control({{"command", "stall_links"}, {"which", "dashboard"}, {"stalled", stalled}});
  };
  set_stalled(true);
  client.socket().send("quit\n");
  client.socket().reset();
  set_stalled(false);
  DashboardClient next(controller.address());
  EXPECT_EQ(next.request("quit"), "Disconnected");
}

TEST_F(DashboardTest, AnswersQueriesAsInManual)
{
  EXPECT_EQ(client.request("robotmode"), "Robotmode: RUNNING");
  EXPECT_EQ(client.request("safetymode"), "Safetymode: NORMAL");
  EXPECT_EQ(client.request("safetystatus"), "Safetystatus: NORMAL");
  EXPECT_EQ(client.request("running"), "Program running: false");
  EXPECT_EQ(client.request("programState"), "STOPPED <unnamed>");
  EXPECT_EQ(client.request("isProgramSaved"), "false <unnamed>");
  EXPECT_EQ(client.request("get loaded program"), "No program loaded");
  EXPECT_EQ(client.request("is in remote control"), "true");
  EXPECT_EQ(client.request("get robot model"), "UR10");
  EXPECT_EQ(client.request("get operational mode"), "NONE");
  EXPECT_TRUE(std::regex_match(client.request("get serial number"), std::regex("\\d+")));
  EXPECT_TRUE(std::regex_match(client.request("PolyscopeVersion"),
                               std::regex("URSoftware \\d+\\.\\d+\\.\\d+\\.\\d+ .*")));
  EXPECT_EQ(client.request("version"), "5.25.1.0");
}

TEST_F(DashboardTest, IgnoresCaseAndCarriageReturns)
{
  EXPECT_EQ(client.request("ROBOTMODE\r"), "Robotmode: RUNNING");
  EXPECT_EQ(client.request("polyscopeversion").substr(0, 10), "URSoftware");
}

TEST_F(DashboardTest, RejectsUnknownCommands)
{
  EXPECT_EQ(client.request("dance"), "could not understand: 'dance'");
  EXPECT_EQ(client.request(""), "could not understand: ''");
  EXPECT_EQ(client.request("setUserRole operator"), "could not understand: 'setUserRole operator'");
}

TEST_F(DashboardTest, AnswersStopWithoutProgram)
{
  EXPECT_EQ(client.request("stop"), "Stopped");
}

TEST_F(DashboardTest, LoadsPlaysPausesAndStopsProgram)
{
  store_program("endless.urp", endless_program);
  EXPECT_EQ(client.request("load endless.urp"), "Loading program: endless.urp");
  EXPECT_EQ(client.request("get loaded program"), "Loaded program: /programs/endless.urp");
  EXPECT_EQ(client.request("play"), "Starting program");
  EXPECT_TRUE(wait_for_program_state(controller, "PLAYING"));
  EXPECT_EQ(client.request("running"), "Program running: true");
  EXPECT_EQ(client.request("programState"), "PLAYING endless.urp");
  EXPECT_EQ(client.request("pause"), "Pausing program");
  EXPECT_TRUE(wait_for_program_state(controller, "PAUSED"));
  EXPECT_EQ(client.request("programState"), "PAUSED endless.urp");
  EXPECT_EQ(client.request("play"), "Starting program");
  EXPECT_TRUE(wait_for_program_state(controller, "PLAYING"));
  EXPECT_EQ(client.request("stop"), "Stopped");
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
}

TEST_F(DashboardTest, AnswersPauseAndStopWhenTheArmIsAtRest)
{
  for (const auto & [request, answer, state] :
       {std::array{"pause", "Pausing program", "PAUSED"}, std::array{"stop", "Stopped", "STOPPED"}}) {
    const json sent = controller.control(
        {{"command", "run_script"}, {"script", "def turn():\n  speedj([1,0,0,0,0,0], 5, 100)\nend\n"}});
    ASSERT_TRUE(sent["ok"]) << sent;
    ASSERT_TRUE(controller.wait_until([](const json & now) { return now["actual"]["velocity"][0] > 0.9; },
                                      seconds(10)));
    EXPECT_EQ(client.request(request), answer);
    const json now = controller.control({{"command", "state"}})["state"];
    EXPECT_EQ(now["program"]["state"], state);
    EXPECT_NEAR(now["target"]["velocity"][0].get<double>(), 0.0, 1e-3);
  }
}

TEST_F(DashboardTest, NamesProgramWithoutFolder)
{
  store_program("cell/pick.urp", endless_program);
  EXPECT_EQ(client.request("load cell/pick.urp"), "Loading program: cell/pick.urp");
  EXPECT_EQ(client.request("get loaded program"), "Loaded program: /programs/cell/pick.urp");
  EXPECT_EQ(client.request("programState"), "STOPPED pick.urp");
  EXPECT_EQ(client.request("isProgramSaved"), "true pick.urp");
}

TEST_F(DashboardTest, RejectsMissingAndInvalidPrograms)
{
  store_program("broken.urp", "def broken(:\n");
  EXPECT_EQ(client.request("load missing.urp"), "File not found: missing.urp");
  EXPECT_EQ(client.request("load broken.urp"), "Error while loading program: broken.urp");
  EXPECT_EQ(client.request("play"), "Failed to execute: play");
  EXPECT_EQ(client.request("pause"), "Failed to execute: pause");
}

TEST_F(DashboardTest, PowersOffAndOnAndReleasesBrakes)
{
  store_program("endless.urp", endless_program);
  client.request("load endless.urp");
  EXPECT_EQ(client.request("power off"), "Powering off");
  EXPECT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(20)));
  EXPECT_EQ(client.request("play"), "Failed to execute: play");
  EXPECT_EQ(client.request("power on"), "Powering on");
  EXPECT_TRUE(wait_for_robot_mode(controller, "IDLE", seconds(20)));
  EXPECT_EQ(client.request("brake release"), "Brake releasing");
  EXPECT_TRUE(wait_for_robot_mode(controller, "RUNNING", seconds(20)));
}

TEST_F(DashboardTest, PowersOnAfterRestartOfSafety)
{
  controller.control({{"command", "violation"}});
  ASSERT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(20)));
  EXPECT_EQ(client.request("restart safety"), "Restarting safety");
  EXPECT_EQ(client.request("power on"), "Powering on");
  EXPECT_TRUE(wait_for_robot_mode(controller, "IDLE", seconds(30)));
  EXPECT_EQ(client.request("safetymode"), "Safetymode: NORMAL");
}

TEST_F(DashboardTest, ConfirmsPowerCommandsThatHaveNoEffect)
{
  controller.control({{"command", "emergency_stop"}});
  ASSERT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(20)));
  EXPECT_EQ(client.request("power on"), "Powering on");
  EXPECT_EQ(client.request("brake release"), "Brake releasing");
  EXPECT_EQ(client.request("restart safety"), "Restarting safety");
  EXPECT_EQ(client.request("robotmode"), "Robotmode: POWER_OFF");
  EXPECT_TRUE(log_contains(controller, "power on was rejected: cannot power on"));
  EXPECT_TRUE(log_contains(controller, "restart safety was rejected"));
}

TEST_F(DashboardTest, UnlocksProtectiveStopAfterFiveSecondsOnly)
{
  controller.control({{"command", "protective_stop"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "PROTECTIVE_STOP", seconds(5)));
  EXPECT_EQ(client.request("unlock protective stop").substr(0, 46),
            "Cannot unlock protective stop until 5s after o");
  ASSERT_TRUE(wait_simulated_time(controller, 5.1, seconds(30)));
  EXPECT_EQ(client.request("unlock protective stop"), "Protective stop releasing");
  EXPECT_TRUE(wait_for_safety_mode(controller, "NORMAL", seconds(5)));
}

TEST_F(DashboardTest, ShowsAndClosesPopups)
{
  EXPECT_EQ(client.request("popup mind the gap"), "showing popup");
  EXPECT_EQ(controller.state()["popup"], "mind the gap");
  EXPECT_EQ(client.request("close popup"), "closing popup");
  EXPECT_TRUE(controller.state()["popup"].is_null());
}

TEST_F(DashboardTest, AddsMessagesToLog)
{
  EXPECT_EQ(client.request("addToLog shift begins"), "Added log message");
  EXPECT_EQ(client.request("addToLog"), "No log message to add");
  EXPECT_TRUE(log_contains(controller, "shift begins"));
}

TEST_F(DashboardTest, RejectsCommandsInLocalControlUntilReconnected)
{
  controller.control({{"command", "remote_control"}, {"on", false}});
  EXPECT_EQ(client.request("power off").substr(0, 44), "Command is not allowed due to safety reasons");
  EXPECT_EQ(client.request("is in remote control"), "false");
  DashboardClient connected_in_local_control(controller.address());
  controller.control({{"command", "remote_control"}, {"on", true}});
  EXPECT_EQ(connected_in_local_control.request("stop").substr(0, 22), "Command is not allowed");
  EXPECT_EQ(DashboardClient(controller.address()).request("stop"), "Stopped");
}

TEST_F(DashboardTest, LoadsInstallationsByName)
{
  EXPECT_EQ(client.request("load installation default.installation"),
            "Loading installation: default.installation");
  EXPECT_EQ(client.request("load installation cell.installation"), "File not found: cell.installation");
  controller.control({{"command", "store_program"}, {"name", "cell.installation"}, {"script", ""}});
  EXPECT_EQ(client.request("load installation cell.installation"), "Loading installation: cell.installation");
}

TEST_F(DashboardTest, ClosesConnectionOnTooLongLine)
{
  client.socket().send(std::string(100000, 'x'));
  EXPECT_TRUE(client.socket().closed_by_peer());
  EXPECT_EQ(DashboardClient(controller.address()).request("robotmode"), "Robotmode: RUNNING");
}

TEST_F(DashboardTest, ShutdownSwitchesControllerOff)
{
  EXPECT_EQ(client.request("shutdown"), "Shutting down");
  EXPECT_TRUE(client.socket().closed_by_peer());
  const auto rejected = [address = controller.address()] {
    try {
      TcpClient(address, 29999);
      return false;
    } catch (const std::runtime_error &) {
      return true;
    }
  };
  // The ports are closed after the connections.
  EXPECT_TRUE(
      controller.wait_until([&](const nlohmann::json &) { return rejected(); }, std::chrono::seconds(5)));
}

TEST(DashboardCb3Test, HasUserRolesButNoOperationalModes)
{
  SimulatorOptions options;
  options.model = "ur5";
  SimulatedController controller(with_unique_address(options));
  DashboardClient client(controller.address());
  EXPECT_EQ(client.request("setUserRole operator"), "Setting user role: operator");
  EXPECT_EQ(client.request("getUserRole"), "OPERATOR");
  EXPECT_EQ(client.request("get operational mode"), "could not understand: 'get operational mode'");
  EXPECT_EQ(client.request("get robot model"), "UR5");
}

}  // namespace
}  // namespace ur_simulator::testing
