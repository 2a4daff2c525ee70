#include "support/primary_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using ClientInterfaceTest = SimulatorTest;

bool wait_for_output(SimulatedController & controller, std::size_t number, bool value)
{
  return controller.wait_until(
      [=](const json & state) {
        return ((state["io"]["digital_outputs"].get<std::uint64_t>() >> number) & 1u) == value;
      },
      seconds(5));
}

TEST_F(ClientInterfaceTest, RunsScriptsOnAllThreePorts)
{
  std::size_t output = 0;
  for (const std::uint16_t port : {30001, 30002, 30003}) {
    TcpClient client(controller.address(), port);
    client.send("def mine():\n  set_standard_digital_out(" + std::to_string(output) + ", True)\nend\n");
    EXPECT_TRUE(wait_for_output(controller, output, true)) << port;
    ++output;
  }
}

TEST_F(ClientInterfaceTest, ReplacesRunningProgram)
{
  TcpClient client(controller.address(), 30003);
  client.send("def first():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program_state(controller, "PLAYING"));
  client.send("def second():\n  while True:\n    sync()\n  end\nend\n");
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["program"]["name"] == "second"; },
                                    seconds(5)));
}

TEST_F(ClientInterfaceTest, AScriptBeginsAfterItsCompilationAlsoAfterAStop)
{
  controller.control({{"command", "compile_time"}, {"seconds", 0.5}});
  TcpClient client(controller.address(), 30003);
  const double sent = controller.state()["timestamp"].get<double>();
  client.send("def late():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_simulated_time(controller, 0.2, seconds(5)));
  EXPECT_EQ(controller.state()["program"]["state"], "STOPPED");
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(wait_for_program_state(controller, "PLAYING"));
  EXPECT_GE(controller.state()["timestamp"].get<double>(), sent + 0.5);
}

TEST_F(ClientInterfaceTest, RunsSecondaryProgramsInParallel)
{
  TcpClient client(controller.address(), 30002);
  client.send("def main_program():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program_state(controller, "PLAYING"));
  client.send("sec light():\n  set_standard_digital_out(3, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 3, true));
  EXPECT_EQ(controller.state()["program"]["name"], "main_program");
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
}

TEST_F(ClientInterfaceTest, AssemblesProgramFromPieces)
{
  TcpClient client(controller.address(), 30002);
  for (const char byte : std::string("def slow():\n  set_standard_digital_out(1, True)\nend\n")) {
    client.send(std::string(1, byte));
  }
  EXPECT_TRUE(wait_for_output(controller, 1, true));
}

TEST_F(ClientInterfaceTest, ReportsCompileErrorsToLogAndPrimaryClients)
{
  PrimaryClient client(controller.address(), 30001);
  client.receive_message(20);  // version message
  client.socket().send("def bad():\n  no_such_function()\nend\n");
  const std::string message = client.receive_message(20);
  EXPECT_EQ(message[10], 10);  // runtime exception
  EXPECT_NE(message.find("no_such_function"), std::string::npos);
  EXPECT_TRUE(log_contains(controller, "no_such_function"));
}

TEST_F(ClientInterfaceTest, ReportsRunTimeErrors)
{
  TcpClient client(controller.address(), 30002);
  client.send("def fails():\n  sync()\n  a = [1, 2]\n  b = a[7]\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "program 'fails' failed in line"));
  EXPECT_TRUE(wait_for_program_state(controller, "STOPPED"));
}

TEST_F(ClientInterfaceTest, RejectsProgramsWhilePoweredOff)
{
  controller.control({{"command", "power"}, {"to", "off"}});
  ASSERT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(10)));
  TcpClient client(controller.address(), 30002);
  client.send("def nothing():\n  sync()\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "robot mode is POWER_OFF"));
  EXPECT_EQ(controller.state()["program"]["state"], "STOPPED");
}

TEST_F(ClientInterfaceTest, KeepsClientsThatDoNotRead)
{
  TcpClient client(controller.address(), 30003);
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["timestamp"].get<double>() > 2.0; },
                                    seconds(20)));
  client.send("def late():\n  set_standard_digital_out(2, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 2, true));
}

TEST_F(ClientInterfaceTest, HandlesRandomBytes)
{
  for (const std::uint16_t port : {30001, 30002, 30003}) {
    TcpClient client(controller.address(), port);
    std::string noise;
    for (int i = 0; i < 20000; ++i) {
      noise += static_cast<char>((i * 7919 + i / 256) % 256);
    }
    client.send(noise + "\n");
  }
  TcpClient client(controller.address(), 30002);
  client.send("def fine():\n  set_standard_digital_out(0, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 0, true));
}

TEST_F(ClientInterfaceTest, RealTimeInterfaceSendsStateInEachCycle)
{
  TcpClient client(controller.address(), 30003);
  const std::string first = client.receive(1220);
  EXPECT_EQ(decode_uint(first.substr(0, 4)), 1220u);
  const std::string second = client.receive(1220);
  EXPECT_NEAR(decode_double(second.substr(4, 8)) - decode_double(first.substr(4, 8)), 0.002, 1e-9);
  const json joints = controller.state()["actual"]["position"];
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(decode_double(second.substr(252 + 8 * i, 8)), joints[i].get<double>(), reading_noise);
  }
}

}  // namespace
}  // namespace ur_simulator::testing
