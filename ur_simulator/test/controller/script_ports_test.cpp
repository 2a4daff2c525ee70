#include "support/raw_socket.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

using ScriptPorts = SimulatorTest;

bool wait_for_output(SimulatedController & controller, std::size_t number, bool value)
{
  return controller.wait_until(
      [=](const json & state) {
        return ((state["io"]["digital_outputs"].get<std::uint64_t>() >> number) & 1u) == value;
      },
      seconds(5));
}

/// The next robot message (type 20); the robot's state comes in between ten times a second.
std::string next_robot_message(RawSocket & client)
{
  for (;;) {
    std::string message = client.receive(number(client.receive(4)) - 4);
    if (message[0] == 20) {
      return message;
    }
  }
}

TEST_F(ScriptPorts, run_what_they_receive_on_each_of_the_three)
{
  std::size_t output = 0;
  for (const std::uint16_t port : {30001, 30002, 30003}) {
    RawSocket client(controller.address(), port);
    client.send("def mine():\n  set_standard_digital_out(" + std::to_string(output) + ", True)\nend\n");
    EXPECT_TRUE(wait_for_output(controller, output, true)) << port;
    ++output;
  }
}

TEST_F(ScriptPorts, replace_the_running_program)
{
  RawSocket client(controller.address(), 30003);
  client.send("def first():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program(controller, "PLAYING"));
  client.send("def second():\n  while True:\n    sync()\n  end\nend\n");
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["program"]["name"] == "second"; },
                                    seconds(5)));
}

TEST_F(ScriptPorts, run_secondary_programs_beside_the_running_one)
{
  RawSocket client(controller.address(), 30002);
  client.send("def main_program():\n  while True:\n    sync()\n  end\nend\n");
  ASSERT_TRUE(wait_for_program(controller, "PLAYING"));
  client.send("sec light():\n  set_standard_digital_out(3, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 3, true));
  EXPECT_EQ(controller.state()["program"]["name"], "main_program");
  EXPECT_EQ(controller.state()["program"]["state"], "PLAYING");
}

TEST_F(ScriptPorts, put_programs_together_from_pieces)
{
  RawSocket client(controller.address(), 30002);
  for (const char byte : std::string("def slow():\n  set_standard_digital_out(1, True)\nend\n")) {
    client.send(std::string(1, byte));
  }
  EXPECT_TRUE(wait_for_output(controller, 1, true));
}

TEST_F(ScriptPorts, explain_programs_that_do_not_compile_in_the_log_and_to_primary_clients)
{
  RawSocket client(controller.address(), 30001);
  const std::size_t version_size = number(client.receive(4));
  client.receive(version_size - 4);
  client.send("def bad():\n  no_such_function()\nend\n");
  const std::string message = next_robot_message(client);
  EXPECT_EQ(message[10], 10);  // runtime exception
  EXPECT_NE(message.find("no_such_function"), std::string::npos);
  EXPECT_TRUE(logged(controller, "no_such_function"));
}

TEST_F(ScriptPorts, report_programs_that_fail_while_they_run)
{
  RawSocket client(controller.address(), 30002);
  client.send("def fails():\n  sync()\n  a = [1, 2]\n  b = a[7]\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "program 'fails' failed in line"));
  EXPECT_TRUE(wait_for_program(controller, "STOPPED"));
}

TEST_F(ScriptPorts, do_not_start_programs_while_powered_off)
{
  controller.control({{"command", "power"}, {"to", "off"}});
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["robot_mode"] == "POWER_OFF"; },
                                    seconds(10)));
  RawSocket client(controller.address(), 30002);
  client.send("def nothing():\n  sync()\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "robot mode is POWER_OFF"));
  EXPECT_EQ(controller.state()["program"]["state"], "STOPPED");
}

TEST_F(ScriptPorts, keep_clients_that_never_read)
{
  RawSocket client(controller.address(), 30003);
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["timestamp"].get<double>() > 2.0; },
                                    seconds(20)));
  client.send("def late():\n  set_standard_digital_out(2, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 2, true));
}

TEST_F(ScriptPorts, survive_noise)
{
  for (const std::uint16_t port : {30001, 30002, 30003}) {
    RawSocket client(controller.address(), port);
    std::string noise;
    for (int i = 0; i < 20000; ++i) {
      noise += static_cast<char>((i * 7919 + i / 256) % 256);
    }
    client.send(noise + "\n");
  }
  RawSocket client(controller.address(), 30002);
  client.send("def fine():\n  set_standard_digital_out(0, True)\nend\n");
  EXPECT_TRUE(wait_for_output(controller, 0, true));
}

TEST_F(ScriptPorts, the_real_time_port_sends_the_state_each_cycle)
{
  RawSocket client(controller.address(), 30003);
  const std::string first = client.receive(1220);
  EXPECT_EQ(number(first.substr(0, 4)), 1220u);
  const std::string second = client.receive(1220);
  EXPECT_NEAR(real(second.substr(4, 8)) - real(first.substr(4, 8)), 0.002, 1e-9);
  const json joints = controller.state()["actual"]["position"];
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(real(second.substr(252 + 8 * i, 8)), joints[i].get<double>(), 1e-6);
  }
}

}  // namespace
}  // namespace ur_simulator::testing
