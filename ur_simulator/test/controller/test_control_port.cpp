#include "state/cycle_trace.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"
#include "support/tcp_client.hpp"

namespace ur_simulator::testing {
namespace {

class ControlPortTest : public SimulatorTest {
 protected:
  json request(const std::string & line)
  {
    client.send(line + "\n");
    return json::parse(client.receive_line());
  }
  std::string request_error(const std::string & line)
  {
    const json reply = request(line);
    return reply["ok"] == false ? reply["error"].get<std::string>() : "no error";
  }
  TcpClient client{controller.address(), 30099};
};

TEST_F(ControlPortTest, ListsItsCommands)
{
  const json reply = request(R"({"command": "help"})");
  ASSERT_TRUE(reply["ok"]);
  EXPECT_GT(reply["commands"].size(), 20u);
}

TEST_F(ControlPortTest, NamesFieldAndValueOfInvalidRequests)
{
  EXPECT_EQ(request_error("{"), "the line is not JSON: send one object per line");
  EXPECT_NE(request_error("[]").find("JSON object"), std::string::npos);
  EXPECT_EQ(request_error("{}"), "field 'command' is missing");
  EXPECT_EQ(request_error(R"({"command": 5})"), "field 'command' is 5: it must be a string");
  EXPECT_NE(request_error(R"({"command": "fly"})").find("'fly' is not known"), std::string::npos);
  EXPECT_EQ(request_error(R"({"command": "push"})"), "field 'wrench' is missing");
  EXPECT_NE(request_error(R"({"command": "push", "force": [1, 2]})").find("array of 3 numbers"),
            std::string::npos);
  EXPECT_NE(request_error(R"({"command": "push", "force": [0, 1e9, 0]})")
                .find("'force[1]' is 1000000000.0: it must be between"),
            std::string::npos);
  EXPECT_NE(request_error(R"({"command": "push", "force": [0, 1, 0], "durration": 1})")
                .find("'durration' is not known"),
            std::string::npos);
  EXPECT_NE(
      request_error(R"({"command": "push", "force": [0, 1, 0], "frame": "sky"})").find("one of base, tool"),
      std::string::npos);
  EXPECT_NE(
      request_error(R"({"command": "set_digital_input", "number": 18, "value": true})").find("from 0 to 17"),
      std::string::npos);
  EXPECT_NE(request_error(R"({"command": "set_joints", "joints": [0, 0, 0, 0, 0, 100]})").find("joints[5]"),
            std::string::npos);
}

TEST(SetJointsTest, TheLastJointOfAUr3eIsEndless)
{
  SimulatorOptions options;
  options.model = "ur3e";
  SimulatedController controller(with_unique_address(options));
  const json reply =
      controller.control({{"command", "set_joints"}, {"joints", {0.0, -1.57, 1.57, -1.57, -1.57, 12.6}}});
  EXPECT_TRUE(reply["ok"]) << reply;
  const json beyond =
      controller.control({{"command", "set_joints"}, {"joints", {0.0, -1.57, 1.57, -1.57, 12.6, 0.0}}});
  EXPECT_EQ(beyond["error"],
            "field 'joints[4]' is 12.6: it must be between -6.283185307179586 and 6.283185307179586 rad");
}

TEST_F(ControlPortTest, PushRaisesTcpForceAndEnds)
{
  ASSERT_TRUE(request(R"({"command": "push", "force": [0, 25, 0], "duration": 0.2})")["ok"]);
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return state["actual_tcp_force"][1].get<double>() > 15.0; }, seconds(5)));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual_tcp_force"][1].get<double>()) < 3.0; },
      seconds(5)));
}

TEST_F(ControlPortTest, SetsInputs)
{
  ASSERT_TRUE(request(R"({"command": "set_digital_input", "number": 9, "value": true})")["ok"]);
  ASSERT_TRUE(request(R"({"command": "set_analog_input", "number": 1, "value": 2.5})")["ok"]);
  const json io = controller.state()["io"];
  EXPECT_EQ(io["digital_inputs"], 512);
  EXPECT_EQ(io["analog_inputs"][1], 2.5);
}

TEST_F(ControlPortTest, DropsOnlyConnectionsOfSelectedClients)
{
  RtdeClient io(controller.address());
  ASSERT_TRUE(io.negotiate(2));
  io.setup_inputs("input_int_register_0");
  RtdeClient receive(controller.address());
  ASSERT_TRUE(receive.negotiate(2));
  receive.setup_outputs(10.0, "timestamp");
  EXPECT_EQ(request(R"({"command": "drop_links", "which": "rtde", "clients": "io"})")["connections"], 1);
  EXPECT_TRUE(io.socket().closed_by_peer());
  EXPECT_EQ(receive.request('v', "").size(), 16u);
}

TEST_F(ControlPortTest, StalledConnectionIsSilentUntilResumed)
{
  RtdeClient rtde_client(controller.address());
  ASSERT_TRUE(rtde_client.negotiate(2));
  ASSERT_TRUE(request(R"({"command": "stall_links", "which": "rtde"})")["ok"]);
  rtde_client.send('v', "");
  EXPECT_THROW(rtde_client.socket().receive(1, milliseconds(100)), std::runtime_error);
  ASSERT_TRUE(request(R"({"command": "stall_links", "which": "rtde", "stalled": false})")["ok"]);
  EXPECT_EQ(rtde_client.receive('v').payload.size(), 16u);
}

TEST_F(ControlPortTest, RefusesAndAcceptsConnections)
{
  ASSERT_TRUE(request(R"({"command": "refuse_connections", "which": "rtde"})")["ok"]);
  EXPECT_THROW(RtdeClient(controller.address()), std::runtime_error);
  ASSERT_TRUE(request(R"({"command": "accept_connections", "which": "rtde"})")["ok"]);
  EXPECT_TRUE(RtdeClient(controller.address()).negotiate(2));
}

TEST_F(ControlPortTest, RebootsController)
{
  RtdeClient rtde_client(controller.address());
  ASSERT_TRUE(rtde_client.negotiate(2));
  // Longer than a late host needs to see that the controller is off; the next reboot ends it.
  ASSERT_TRUE(request(R"({"command": "reboot", "duration": 600})")["ok"]);
  EXPECT_TRUE(rtde_client.socket().closed_by_peer());
  EXPECT_THROW(RtdeClient(controller.address()), std::runtime_error);
  ASSERT_TRUE(request(R"({"command": "reboot", "duration": 0.2})")["ok"]);
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) {
        return state["timestamp"].get<double>() > 0.25 && state["robot_mode"] == "POWER_OFF";
      },
      seconds(5)));
  EXPECT_TRUE(RtdeClient(controller.address()).negotiate(2));
}

TEST_F(ControlPortTest, TracesCommandsAndRepeatsButNotWatchdogKicks)
{
  RtdeClient rtde_client(controller.address());
  ASSERT_TRUE(rtde_client.negotiate(2));
  rtde_client.setup_inputs("input_int_register_0,input_double_register_0");
  rtde_client.setup_inputs("input_int_register_0");
  const auto servo = [&](double target) {
    rtde_client.send('U', data_package_header(1) + encode_int32(11) + encode_double(target));
  };
  servo(0.1);
  servo(0.2);
  rtde_client.send('U', data_package_header(2) + encode_int32(11));
  servo(0.2);
  rtde_client.send('U', data_package_header(2) + encode_int32(0));
  rtde_client.send('U', data_package_header(2) + encode_int32(66));
  json trace;
  for (bool all = false; !all;) {
    trace = request(R"({"command": "trace"})");
    all = !trace["commands"].empty() && trace["commands"].back()[2] == 66;
  }
  ASSERT_EQ(trace["commands"].size(), 2U) << trace["commands"];
  EXPECT_EQ(trace["commands"][0][2], 11);
  ASSERT_EQ(trace["repeats"].size(), 2U) << trace["repeats"];
  EXPECT_EQ(trace["repeats"][0][2], 11);
  EXPECT_LE(trace["repeats"][0][1], trace["repeats"][1][1]);
  EXPECT_EQ(trace["repeats"][0][3], false) << "a new target";
  EXPECT_EQ(trace["repeats"][1][3], true) << "the target before";
}

TEST_F(ControlPortTest, TraceFailsIfRequestedCyclesWereOverwritten)
{
  constexpr std::size_t capacity = CycleTrace::command_capacity;
  RtdeClient rtde_client(controller.address());
  ASSERT_TRUE(rtde_client.negotiate(2));
  rtde_client.setup_inputs("input_int_register_0");
  const auto after_1 = R"({"command": "trace", "after": 1})";
  EXPECT_TRUE(request(after_1)["ok"]);
  for (std::size_t i = 0; i <= capacity; ++i) {
    rtde_client.send('U', data_package_header(1) + encode_int32(static_cast<std::int32_t>(1 + i % 2)));
  }
  std::string error = "no error";
  while (error == "no error" && wait_for_next_cycle(controller)) {
    error = request_error(after_1);
  }
  EXPECT_NE(error.find("'after' is 1: the trace is complete only after cycle "), std::string::npos) << error;
  EXPECT_EQ(request(R"({"command": "trace"})")["commands"].size(), capacity);
}

TEST_F(ControlPortTest, RebootClearsTrace)
{
  ASSERT_TRUE(wait_simulated_time(controller, 0.4, seconds(5)));
  ASSERT_TRUE(request(R"({"command": "reboot", "duration": 0.01})")["ok"]);
  json cycles;
  while (cycles.empty() && wait_for_next_cycle(controller)) {
    cycles = request(R"({"command": "trace"})")["cycles"];
  }
  ASSERT_FALSE(cycles.empty());
  EXPECT_LE(cycles.front()[0].get<int>(), 10);
  EXPECT_EQ(static_cast<int>(cycles.size()), cycles.back()[0].get<int>() - cycles.front()[0].get<int>() + 1);
}

TEST_F(ControlPortTest, SetsJointPositions)
{
  ASSERT_TRUE(request(R"({"command": "set_joints", "joints": [0.1, -1.2, 1.3, -1.4, -1.5, 0.6]})")["ok"]);
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return std::abs(state["actual"]["position"][5].get<double>() - 0.6) < 1e-6; },
      seconds(5)));
}

TEST_F(ControlPortTest, RejectsDeeplyNestedRequests)
{
  constexpr std::size_t depth = 400000;
  EXPECT_NE(request_error(R"({"command": )" + std::string(depth, '[') + std::string(depth, ']') + "}")
                .find("nested"),
            std::string::npos);
  EXPECT_TRUE(request(R"({"command": "state"})")["ok"]);
}

TEST_F(ControlPortTest, ClosesConnectionOnTooLongLine)
{
  client.send(std::string(1200000, 'x'));
  EXPECT_NE(client.receive_line().find("at most"), std::string::npos);
  EXPECT_TRUE(client.closed_by_peer());
  EXPECT_TRUE(controller.control({{"command", "state"}})["ok"]);
}

}  // namespace
}  // namespace ur_simulator::testing
