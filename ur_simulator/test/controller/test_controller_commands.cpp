#include "support/primary_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr const char * endless_script = "def endless():\n  while True:\n    sync()\n  end\nend\n";

class ControllerCommandTest : public SimulatorTest {
 protected:
  TcpClient client{controller.address(), 30002};
};

TEST_F(ControllerCommandTest, PowersOffAndOnAndReleasesBrakes)
{
  client.send("power off\n");
  EXPECT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(20)));
  client.send("power on\n");
  EXPECT_TRUE(wait_for_robot_mode(controller, "IDLE", seconds(20)));
  client.send("set robotmode run\n");
  EXPECT_TRUE(wait_for_robot_mode(controller, "RUNNING", seconds(20)));
}

TEST_F(ControllerCommandTest, UnlocksProtectiveStopWithoutDelay)
{
  controller.control({{"command", "protective_stop"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "PROTECTIVE_STOP", seconds(5)));
  const double stopped_at = controller.state()["timestamp"];
  EXPECT_EQ(controller.control({{"command", "unlock_protective_stop"}})["ok"], false);
  client.send("set unlock protective stop\n");
  // The normal mode is reached before the delay of the dashboard server has passed in simulated time.
  EXPECT_TRUE(controller.wait_until(
      [&](const json & state) {
        return state["safety_mode"] == "NORMAL" || state["timestamp"].get<double>() > stopped_at + 4.9;
      },
      seconds(30)));
  EXPECT_EQ(controller.state()["safety_mode"], "NORMAL");
}

TEST_F(ControllerCommandTest, StopsPausesAndResumesProgram)
{
  client.send(endless_script);
  ASSERT_TRUE(wait_for_program_state(controller, "PLAYING"));
  client.send("pause program\n");
  EXPECT_TRUE(wait_for_program_state(controller, "PAUSED"));
  client.send("resume program\n");
  EXPECT_TRUE(wait_for_program_state(controller, "PLAYING"));
  client.send("stop program\n");
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
}

TEST_F(ControllerCommandTest, AcceptsCommandsBeforeProgramInSameTransmission)
{
  controller.control({{"command", "protective_stop"}});
  ASSERT_TRUE(wait_for_safety_mode(controller, "PROTECTIVE_STOP", seconds(5)));
  client.send(std::string("stop program\r\nset  unlock protective stop\r\n") + endless_script);
  EXPECT_TRUE(wait_for_program_state(controller, "PLAYING"));
}

TEST_F(ControllerCommandTest, SetsSpeedSlider)
{
  client.send("set speed 0.25\n");
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["speed_slider"] == 0.25; }, seconds(5)));
}

TEST_F(ControllerCommandTest, RejectsCommandsInLocalControl)
{
  controller.control({{"command", "remote_control"}, {"on", false}});
  client.send("power off\n");
  EXPECT_TRUE(wait_for_log(controller, "script was not started: the robot is in local control"));
  EXPECT_EQ(controller.state()["robot_mode"], "RUNNING");
}

}  // namespace
}  // namespace ur_simulator::testing
