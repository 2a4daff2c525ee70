#include "support/simulator_test.hpp"
#include "support/tcp_client.hpp"

namespace ur_simulator::testing {
namespace {

SimulatorOptions robotiq_options()
{
  SimulatorOptions options;
  options.urcaps = {"robotiq_gripper"};
  return options;
}

class RobotiqServerTest : public ::testing::Test {
 protected:
  SimulatedController controller{with_unique_address(robotiq_options())};
  TcpClient client{controller.address(), controller.ports().robotiq};

  void SetUp() override
  {
    ASSERT_TRUE(controller.wait_until(
        [](const json & state) { return state["robotiq_gripper"]["powered"].get<bool>(); }, seconds(10)));
  }
  std::string get(const std::string & name)
  {
    client.send("GET " + name + "\n");
    return client.receive_line();
  }
  bool wait_for(const char * name, int value)
  {
    return controller.wait_until([&](const json & state) { return state["robotiq_gripper"][name] == value; },
                                 seconds(20));
  }
};

TEST_F(RobotiqServerTest, MovesTheGripper)
{
  client.send("SET ACT 1\n");
  EXPECT_EQ(client.receive(3), "ack");
  ASSERT_TRUE(wait_for("STA", 3));
  client.send("SET POS 200 SPE 255 FOR 10 GTO 1\n");
  EXPECT_EQ(client.receive(3), "ack");
  ASSERT_TRUE(wait_for("POS", 200));
  ASSERT_TRUE(wait_for("OBJ", 3));
  EXPECT_EQ(get("POS"), "POS 200");
  EXPECT_EQ(get("PRE"), "PRE 200");
}

TEST_F(RobotiqServerTest, AnswersSeveralRequestsOfOneSegment)
{
  client.send("GET ACT\nGET ST");
  client.send("A\nGET FLT\r\n");
  EXPECT_EQ(client.receive_line(), "ACT 0");
  EXPECT_EQ(client.receive_line(), "STA 0");
  EXPECT_EQ(client.receive_line(), "FLT 0");
}

TEST_F(RobotiqServerTest, RejectsWhatItDoesNotKnow)
{
  for (const char * request :
       {"GET XYZ\n", "SET POS\n", "SET POS 256\n", "SET STA 3\n", "SET \n", "hello\n", "\n"}) {
    client.send(request);
    EXPECT_EQ(client.receive(1), "?") << request;
  }
  client.send("SET SPE 7 POS 300\n");
  EXPECT_EQ(client.receive(1), "?");
  EXPECT_EQ(get("SPE"), "SPE 0");
}

TEST_F(RobotiqServerTest, ReportsNoValuesWithoutPower)
{
  ASSERT_TRUE(controller.control({{"command", "power"}, {"to", "off"}})["ok"]);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return !state["robotiq_gripper"]["powered"].get<bool>(); }, seconds(10)));
  EXPECT_EQ(get("STA"), "STA ?");
}

TEST_F(RobotiqServerTest, ClosesTheConnectionAfterALongLine)
{
  client.send(std::string(2000, 'x'));
  EXPECT_TRUE(client.closed_by_peer());
}

TEST_F(RobotiqServerTest, ControlPortPlacesObjectsAndCausesFaults)
{
  const json reply = controller.control(
      {{"command", "robotiq_gripper"}, {"object", 30.0}, {"fault", 14}, {"activate", true}});
  ASSERT_TRUE(reply["ok"]) << reply.dump();
  EXPECT_EQ(get("FLT"), "FLT 14");
  EXPECT_FALSE(controller.control({{"command", "robotiq_gripper"}, {"fault", 16}})["ok"]);
}

TEST(RobotiqUrcapTest, PortIsClosedWithoutUrcap)
{
  SimulatedController controller(with_unique_address());
  EXPECT_THROW(TcpClient(controller.address(), 63352), std::runtime_error);
  EXPECT_NE(controller.control({{"command", "robotiq_gripper"}})["error"].get<std::string>().find("--urcap"),
            std::string::npos);
  EXPECT_NE(controller.control({{"command", "digital_gripper"}})["error"].get<std::string>().find(
                "--digital-gripper"),
            std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
