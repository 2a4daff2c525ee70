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
  EXPECT_EQ(client.receive_line(), "FLT 00");
}

// As a recorded gripper at position 77 answers.
TEST_F(RobotiqServerTest, ValuesHaveTheFormatOfAGripper)
{
  client.send("SET POS 77\nSET MSC 0\nSET MOD 0\nSET SID 9\n");
  EXPECT_EQ(client.receive(12), "ackackackack");
  ASSERT_TRUE(wait_for("PRE", 77));
  EXPECT_EQ(get("PRE"), "PRE 077");
  EXPECT_EQ(get("FLT"), "FLT 00");
  EXPECT_EQ(get("SID"), "SID [9]");
  for (const std::string name :
       {"MOD", "MSC", "VST", "COU", "SNU", "PYE", "NCY", "PON", "NPA", "FWV", "VER", "DRI", "DST", "PCO"}) {
    EXPECT_EQ(get(name).substr(0, 4), name + " ");
  }
}

TEST_F(RobotiqServerTest, AnswersAGetWithoutLineEndWithTheValueOnly)
{
  client.send("GET STA");
  EXPECT_EQ(client.receive(1), "0");
  client.send("GET PRE");
  EXPECT_EQ(client.receive(3), "000");
  client.send("GET FLT");
  EXPECT_EQ(client.receive(2), "00");
  client.send("GET SID");
  EXPECT_EQ(client.receive(3), "[9]");
  client.send("\n");  // of the request before
  EXPECT_EQ(get("ACT"), "ACT 0");
}

TEST_F(RobotiqServerTest, KnowsOneGripper)
{
  client.send("SET SID 2\n");
  EXPECT_EQ(client.receive(1), "?");
  ASSERT_TRUE(controller.control({{"command", "power"}, {"to", "off"}})["ok"]);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return !state["robotiq_gripper"]["powered"].get<bool>(); }, seconds(10)));
  client.send("SET SID 9\n");
  EXPECT_EQ(client.receive(1), "?");
  EXPECT_EQ(get("SID"), "SID []");
}

/// A program that speaks with the URCap as one with a node of Robotiq does: values without line ends,
/// requests in several pieces, and 17 bytes for the list of grippers.
std::string pendant_program(const std::string & address)
{
  return "def with_gripper():\n  socket_open(\"" + address + R"(", 63352, "1")
  def value_of(request, count):
    socket_send_string(request, "1")
    sync()
    return socket_read_byte_list(count, "1")
  end
  def set(name, value):
    while True:
      socket_set_var(name, value, "1")
      sync()
      if socket_read_byte_list(3, "1") == [3, 97, 99, 107]:
        return True
      end
    end
  end
  def move(position):
    socket_send_string("SET POS", "1")
    socket_send_byte(32, "1")
    socket_send_string(floor(position), "1")
    socket_send_byte(32, "1")
    socket_send_string("SPE 255 FOR 0", "1")
    socket_send_byte(10, "1")
    sync()
    textmsg("moving: ", socket_read_byte_list(3, "1"))
    echo = value_of("GET PRE", 3)
    while (echo[1] - 48) * 100 + (echo[2] - 48) * 10 + echo[3] - 48 != position:
      echo = value_of("GET PRE", 3)
    end
    set("GTO", 1)
    object = value_of("GET OBJ", 1)
    while object[1] == 48:
      object = value_of("GET OBJ", 1)
    end
    textmsg("object: ", object)
    textmsg("position: ", socket_get_var("POS", "1"))
  end
  set("SID", 9)
  textmsg("grippers: ", value_of("GET SID", 17))
  set("ACT", 1)
  while value_of("GET STA", 1) != [1, 51]:
    sync()
  end
  textmsg("fault: ", value_of("GET FLT", 2))
  move(255)
  move(77)
  socket_close("1")
end
)";
}

TEST_F(RobotiqServerTest, ServesAProgramWithAGripperNode)
{
  const json reply =
      controller.control({{"command", "run_script"}, {"script", pendant_program(controller.address())}});
  ASSERT_TRUE(reply["ok"]) << reply.dump();
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["program"]["state"] == "STOPPED"; },
                                    seconds(60)));
  EXPECT_TRUE(log_contains(controller, "grippers: [3, 91, 57, 93, -1, -1, -1, -1, -1"));
  EXPECT_TRUE(log_contains(controller, "fault: [2, 48, 48]"));
  EXPECT_TRUE(log_contains(controller, "moving: [3, 97, 99, 107]"));
  EXPECT_TRUE(log_contains(controller, "object: [1, 51]"));
  EXPECT_TRUE(log_contains(controller, "position: 227"));
  EXPECT_TRUE(log_contains(controller, "position: 77"));
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
