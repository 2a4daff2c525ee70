#include "support/raw_socket.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class ControlPort : public SimulatorTest {
 protected:
  json ask(const std::string & line)
  {
    client.send(line + "\n");
    return json::parse(client.receive_line());
  }
  std::string error(const std::string & line)
  {
    const json reply = ask(line);
    return reply["ok"] == false ? reply["error"].get<std::string>() : "no error";
  }
  RawSocket client{controller.address(), 30099};
};

TEST_F(ControlPort, lists_its_commands)
{
  const json reply = ask(R"({"command": "help"})");
  ASSERT_TRUE(reply["ok"]);
  EXPECT_GT(reply["commands"].size(), 20u);
}

TEST_F(ControlPort, names_what_is_wrong_with_a_request)
{
  EXPECT_EQ(error("{"), "the line is not JSON: one object a line");
  EXPECT_NE(error("[]").find("JSON object"), std::string::npos);
  EXPECT_EQ(error("{}"), "field 'command' is missing");
  EXPECT_EQ(error(R"({"command": 5})"), "field 'command' is 5: it must be a string");
  EXPECT_NE(error(R"({"command": "fly"})").find("'fly' is not known"), std::string::npos);
  EXPECT_EQ(error(R"({"command": "push"})"), "field 'wrench' is missing");
  EXPECT_NE(error(R"({"command": "push", "force": [1, 2]})").find("array of 3 numbers"), std::string::npos);
  EXPECT_NE(error(R"({"command": "push", "force": [0, 1e9, 0]})")
                .find("'force[1]' is 1000000000.0: it must be between"),
            std::string::npos);
  EXPECT_NE(
      error(R"({"command": "push", "force": [0, 1, 0], "durration": 1})").find("'durration' is not known"),
      std::string::npos);
  EXPECT_NE(error(R"({"command": "push", "force": [0, 1, 0], "frame": "sky"})").find("one of base, tool"),
            std::string::npos);
  EXPECT_NE(error(R"({"command": "set_digital_input", "number": 18, "value": true})").find("from 0 to 17"),
            std::string::npos);
  EXPECT_NE(error(R"({"command": "set_joints", "joints": [0, 0, 0, 0, 0, 100]})").find("joints[5]"),
            std::string::npos);
}

TEST_F(ControlPort, a_push_is_felt_and_passes)
{
  ASSERT_TRUE(ask(R"({"command": "push", "force": [0, 25, 0], "duration": 0.2})")["ok"]);
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return state["actual_tcp_force"][1].get<double>() > 15.0; }, seconds(5)));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual_tcp_force"][1].get<double>()) < 3.0; },
      seconds(5)));
}

TEST_F(ControlPort, inputs_are_set)
{
  ASSERT_TRUE(ask(R"({"command": "set_digital_input", "number": 9, "value": true})")["ok"]);
  ASSERT_TRUE(ask(R"({"command": "set_analog_input", "number": 1, "value": 2.5})")["ok"]);
  const json io = controller.state()["io"];
  EXPECT_EQ(io["digital_inputs"], 512);
  EXPECT_EQ(io["analog_inputs"][1], 2.5);
}

TEST_F(ControlPort, drops_the_links_of_one_kind_only)
{
  RtdeClient io(controller.address());
  ASSERT_TRUE(io.negotiate(2));
  io.inputs("input_int_register_0");
  RtdeClient receive(controller.address());
  ASSERT_TRUE(receive.negotiate(2));
  receive.outputs(10.0, "timestamp");
  EXPECT_EQ(ask(R"({"command": "drop_links", "which": "rtde", "clients": "io"})")["connections"], 1);
  EXPECT_TRUE(io.socket().closed_by_peer());
  EXPECT_EQ(receive.request('v', "").size(), 16u);
}

TEST_F(ControlPort, a_stalled_link_is_silent_until_it_goes_on)
{
  RtdeClient link(controller.address());
  ASSERT_TRUE(link.negotiate(2));
  ASSERT_TRUE(ask(R"({"command": "stall_links", "which": "rtde"})")["ok"]);
  link.send('v', "");
  EXPECT_THROW(link.socket().receive(1, milliseconds(100)), std::runtime_error);
  ASSERT_TRUE(ask(R"({"command": "stall_links", "which": "rtde", "stalled": false})")["ok"]);
  EXPECT_EQ(link.receive('v').payload.size(), 16u);
}

TEST_F(ControlPort, refuses_and_accepts_connections)
{
  ASSERT_TRUE(ask(R"({"command": "refuse_connections", "which": "rtde"})")["ok"]);
  EXPECT_THROW(RtdeClient(controller.address()), std::runtime_error);
  ASSERT_TRUE(ask(R"({"command": "accept_connections", "which": "rtde"})")["ok"]);
  EXPECT_TRUE(RtdeClient(controller.address()).negotiate(2));
}

TEST_F(ControlPort, reboots_the_controller)
{
  RtdeClient link(controller.address());
  ASSERT_TRUE(link.negotiate(2));
  ASSERT_TRUE(ask(R"({"command": "reboot", "duration": 0.2})")["ok"]);
  EXPECT_TRUE(link.socket().closed_by_peer());
  EXPECT_THROW(RtdeClient(controller.address()), std::runtime_error);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["timestamp"].get<double>() > 0.25 && state["robot_mode"] == "POWER_OFF";
      },
      seconds(5)));
  EXPECT_TRUE(RtdeClient(controller.address()).negotiate(2));
}

TEST_F(ControlPort, traces_commands_and_repeats_but_no_kick_of_a_watchdog)
{
  RtdeClient link(controller.address());
  ASSERT_TRUE(link.negotiate(2));
  link.inputs("input_int_register_0,input_double_register_0");
  link.inputs("input_int_register_0");
  const auto servo = [&](double target) { link.send('U', package_for(1) + int32(11) + float64(target)); };
  servo(0.1);
  servo(0.2);
  link.send('U', package_for(2) + int32(11));
  servo(0.3);
  link.send('U', package_for(2) + int32(0));
  link.send('U', package_for(2) + int32(66));
  json trace;
  for (bool all = false; !all;) {
    trace = ask(R"({"command": "trace"})");
    all = !trace["commands"].empty() && trace["commands"].back()[2] == 66;
  }
  ASSERT_EQ(trace["commands"].size(), 2U) << trace["commands"];
  EXPECT_EQ(trace["commands"][0][2], 11);
  ASSERT_EQ(trace["repeats"].size(), 2U) << trace["repeats"];
  EXPECT_EQ(trace["repeats"][0][2], 11);
  EXPECT_LE(trace["repeats"][0][1], trace["repeats"][1][1]);
}

TEST_F(ControlPort, puts_the_arm_elsewhere)
{
  ASSERT_TRUE(ask(R"({"command": "set_joints", "joints": [0.1, -1.2, 1.3, -1.4, -1.5, 0.6]})")["ok"]);
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual"]["position"][5].get<double>() - 0.6) < 1e-6; },
      seconds(5)));
}

TEST_F(ControlPort, survives_a_line_without_end)
{
  client.send(std::string(1200000, 'x'));
  EXPECT_NE(client.receive_line().find("at most"), std::string::npos);
  EXPECT_TRUE(client.closed_by_peer());
  EXPECT_TRUE(controller.control({{"command", "state"}})["ok"]);
}

}  // namespace
}  // namespace ur_simulator::testing
