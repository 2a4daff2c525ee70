// The client log of a controller: what clients do on each port, as a sequence diagram.
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "support/dashboard_client.hpp"
#include "support/polyscope_x_test.hpp"
#include "support/primary_client.hpp"
#include "support/rtde_client.hpp"
#include "support/sequence_diagram.hpp"
#include "support/simulator_test.hpp"
#include "support/single_reply_server.hpp"
#include "support/temporary_file.hpp"

namespace ur_simulator::testing {
namespace {

using Lines = std::vector<std::string>;

class ControllerClientLogTest : public ::testing::Test {
 protected:
  SimulatorOptions options() const
  {
    SimulatorOptions result;
    result.client_log = file.path();
    result.urcaps = {"robotiq_gripper"};
    return with_unique_address(result);
  }
  const std::string & address() const { return controller->address(); }
  bool wait_for_clients(const std::string & port, int count)
  {
    return controller->wait_until([&](const json & state) { return state["clients"][port] == count; },
                                  seconds(5));
  }
  /// Ends the simulator and returns its log.
  Lines finish()
  {
    controller.reset();
    return read_diagram(file.path());
  }

  TemporaryFile file{"controller_log"};
  std::optional<SimulatedController> controller{std::in_place, options()};
};

/// The lines without the first, which states the port of the client.
Lines after_connecting(const Lines & session)
{
  EXPECT_TRUE(!session.empty() && session.front().starts_with("> connects from 127."));
  return {session.begin() + (session.empty() ? 0 : 1), session.end()};
}

TEST_F(ControllerClientLogTest, ShowsDashboardSession)
{
  {
    DashboardClient client(address());
    client.request("robotmode");
    client.request("no command; 100 %");
    client.request("quit");
  }
  EXPECT_EQ(after_connecting(session_of(finish(), "dashboard client 1")),
            (Lines{"< Connected: Universal Robots Dashboard Server", "> robotmode", "< Robotmode: RUNNING",
                   "> no command#59; 100 #37;", "< could not understand: 'no command#59; 100 #37;'", "> quit",
                   "< Disconnected", "x< closes the connection: quit"}));
}

TEST_F(ControllerClientLogTest, ShowsRtdeNegotiation)
{
  {
    RtdeClient client(address());
    client.negotiate(2);
    client.setup_outputs(500.0, "timestamp,no_such_output");
    client.setup_outputs(100.0, "timestamp,actual_q");
    client.setup_inputs("input_int_register_0,input_double_register_0");
    RtdeClient second(address());
    second.setup_inputs("input_int_register_0,no_such_input,input_int_register_1");
    client.start();
    client.receive('U');
    client.request('P', "");
  }
  ASSERT_TRUE(wait_for_clients("rtde", 0));
  const Lines lines = finish();
  Lines session = after_connecting(session_of(lines, "RTDE client 1"));
  ASSERT_EQ(session.size(), 15u);
  EXPECT_TRUE(session.back().starts_with("data packages: "));
  session.pop_back();
  EXPECT_EQ(
      session,
      (Lines{"> requests RTDE protocol version 2", "< accepted",
             "> requests outputs at 500 Hz: timestamp,no_such_output", "< rejected: no_such_output NOT_FOUND",
             "> requests outputs at 100 Hz: timestamp,actual_q", "< accepted as recipe 1: DOUBLE,VECTOR6D",
             "> requests inputs: input_int_register_0,input_double_register_0",
             "< accepted as recipe 1: INT32,DOUBLE", "> start", "< accepted", "< data packages of 60 bytes",
             "> pause", "< accepted", "x> closes the connection"}));
  EXPECT_EQ(after_connecting(session_of(lines, "RTDE client 2")),
            (Lines{"> requests inputs: input_int_register_0,no_such_input,input_int_register_1",
                   "< rejected: input_int_register_0 IN_USE, no_such_input NOT_FOUND",
                   "x> closes the connection", "data packages: 0 sent, 0 dropped, 0 received"}));
}

TEST_F(ControllerClientLogTest, SummarizesDataPackages)
{
  const auto package = [](int integer, double number) {
    return data_package_header(1) + encode_int32(integer) + encode_double(number);
  };
  {
    RtdeClient client(address());
    client.negotiate(2);
    client.setup_inputs("input_int_register_0,input_double_register_0");
    client.send('U', package(1, 0.5));
    for (int i = 0; i < 40; ++i) {
      client.send('U', package(1, 0.5));
    }
    client.send('U', package(1, -2.25));
    for (int i = 0; i < 100; ++i) {
      client.send('U', package(i, 0.0));
    }
    client.send('U', data_package_header(7));
    client.request('P', "");
  }
  ASSERT_TRUE(wait_for_clients("rtde", 0));
  const Lines session = session_of(finish(), "RTDE client 1");
  const Lines packages = lines_with(session, "data package of recipe");
  ASSERT_GE(packages.size(), 10u);
  EXPECT_LE(packages.size(), 20u);  // 10 at once, 2 per second
  EXPECT_EQ(packages[0], "> data package of recipe 1: input_int_register_0=1, input_double_register_0=0.5");
  EXPECT_EQ(packages[1], "> data package of recipe 1, after 40 others: input_double_register_0=-2.25");
  EXPECT_EQ(lines_with(session, "which was not set up").size(), 1u);
  EXPECT_EQ(session.back(), "data packages: 0 sent, 0 dropped, 142 received");
}

TEST_F(ControllerClientLogTest, ShowsMalformedPackage)
{
  RtdeClient client(address());
  client.send_raw(std::string(3, '\0'));
  EXPECT_TRUE(client.socket().closed_by_peer());
  EXPECT_EQ(
      lines_with(finish(), "robot--xRTDE client 1"),
      Lines{"robot--xRTDE client 1: closes the connection: package size is 0, the header alone has 3 bytes"});
}

TEST_F(ControllerClientLogTest, ShowsScriptsAndTheirPrograms)
{
  {
    PrimaryClient client(address(), 30001);
    client.socket().send("def wrong():\n  no_such_function()\nend\n");
    client.receive_robot_message(10);
    client.socket().send("def right():\n  textmsg(\"in right\")\nend\n");
    client.receive_robot_message(7);
    ASSERT_TRUE(wait_for_log(*controller, "program 'right' ended"));
    client.socket().send("set speed 2\n");
    client.socket().send("stop program\n");
    TcpClient read_only(address(), 30012);
    read_only.send("power off\n");
    ASSERT_TRUE(wait_for_log(*controller, "read-only interface"));
  }
  ASSERT_TRUE(wait_for_clients("primary", 0));
  const Lines lines = finish();
  const std::string error =
      "Compile error on line 2, column 3: The function 'no_such_function' is not defined";
  const Lines session = after_connecting(session_of(lines, "primary client 1"));
  const Lines expected{"> script of 3 lines, 38 bytes: def wrong():",
                       "< runtime exception message",
                       "rejected: " + error,
                       "> script of 3 lines, 39 bytes: def right():",
                       "< key message PROGRAM_XXX_STARTED",
                       "accepted",
                       "< text message",
                       "< key message PROGRAM_XXX_STOPPED",
                       "> set speed 2",
                       "rejected: the speed is '2': give a fraction from 0 to 1",
                       "> stop program",
                       "accepted"};
  ASSERT_GT(session.size(), expected.size());
  EXPECT_EQ(Lines(session.begin(), session.begin() + 12), expected);
  EXPECT_EQ(
      lines_with(lines, "Note over robot: program: "),
      (Lines{"Note over robot: program: script was not started: " + error,
             "Note over robot: program: program 'right' started",
             "Note over robot: program: program 'right' ended",
             "Note over robot: program: script was not started: it was sent to a read-only interface"}));
  EXPECT_EQ(lines_with(session_of(lines, "secondary read only client 1"), "rejected"),
            Lines{"rejected: it was sent to a read-only interface"});
}

TEST_F(ControllerClientLogTest, ShowsStopsAndErrorCodes)
{
  PrimaryClient client(address(), 30001);
  client.receive_message(20);  // the version
  controller->control({{"command", "protective_stop"}, {"reason", "a test"}});
  client.receive_robot_message(6);
  EXPECT_EQ(after_connecting(session_of(finish(), "primary client 1")),
            (Lines{"< safety mode message 3", "< error code message C0A0",
                   "x< closes the connection: the simulator ends"}));
}

TEST_F(ControllerClientLogTest, ShowsSocketsOfPrograms)
{
  const std::string host_address = address();
  SingleReplyServer host(host_address);
  TcpClient client(host_address, 30002);
  client.send("def f():\n  socket_open(\"" + host_address + "\", " + std::to_string(host.port()) +
              ")\n  socket_send_line(\"who\")\n  textmsg(socket_read_line())\nend\n");
  ASSERT_EQ(host.receive_request(), "who\n");
  ASSERT_TRUE(host.send_reply("me\n"));
  ASSERT_TRUE(wait_for_log(*controller, "program 'f' ended"));
  EXPECT_EQ(session_of(finish(), "host 1"),
            (Lines{"< connects to " + host_address + ":" + std::to_string(host.port()), "connected",
                   "< who\\n", "> me\\n", "x< closes the connection: the program closes the socket"}));
}

TEST_F(ControllerClientLogTest, ShowsRequestsOfExternalControl)
{
  const std::string host = address();
  const auto play = [&](std::uint16_t port) {
    controller->control({{"command", "store_external_control"}, {"host", host}, {"port", port}});
    controller->control({{"command", "play"}});
  };
  SingleReplyServer server(host);
  play(server.port());
  ASSERT_EQ(server.receive_request(), "request_program\n");
  ASSERT_TRUE(server.send_reply("textmsg(\"received\")\n"));
  ASSERT_TRUE(wait_for_log(*controller, "received"));
  const std::string endpoint = host + ":" + std::to_string(server.port());
  EXPECT_EQ(session_of(finish(), "host 1"),
            (Lines{"< connects to " + endpoint + ": request_program", "> program of 20 bytes"}));
}

TEST_F(ControllerClientLogTest, ShowsLineServers)
{
  {
    TcpClient gripper(address(), 63352);
    gripper.send("SET POS 3\n");
    EXPECT_EQ(gripper.receive(3), "ack");
    TcpClient control_port(address(), 30099);
    control_port.send("{\"command\": \"speed_slider\", \"fraction\": 3}\n");
    control_port.receive_line();
    control_port.send("{\"command\": \"state\"}\n");
    control_port.receive_line();
  }
  ASSERT_TRUE(wait_for_clients("robotiq", 0));
  const Lines lines = finish();
  EXPECT_EQ(after_connecting(session_of(lines, "robotiq client 1")),
            (Lines{"> SET POS 3", "< ack", "x> closes the connection"}));
  const Lines session = after_connecting(session_of(lines, "control port client 1"));
  ASSERT_GE(session.size(), 4u);
  EXPECT_EQ(session[0], "> {\"command\": \"speed_slider\", \"fraction\": 3}");
  EXPECT_TRUE(session[1].starts_with("< {\"error\":\"field 'fraction' is 3")) << session[1];
  EXPECT_TRUE(session[3].ends_with(" more bytes)")) << session[3];
}

TEST(RobotApiClientLogTest, ShowsRequestsAndReplies)
{
  const TemporaryFile file("robot_api_log");
  SimulatorOptions options = polyscope_x_options("10.14.0");
  options.client_log = file.path();
  {
    SimulatedController controller(options);
    HttpClient client(controller.address(), controller.ports().robot_api);
    EXPECT_EQ(client.request("POST", "/no/such/path", "{}").status, 404);
    client.socket().shut_down_sending();
    EXPECT_TRUE(client.socket().closed_by_peer());
  }
  const Lines session = after_connecting(session_of(read_diagram(file.path()), "robot api client 1"));
  ASSERT_EQ(session.size(), 3u);
  EXPECT_EQ(session[0], "> POST /universal-robots/robot-api/no/such/path {}");
  EXPECT_TRUE(session[1].starts_with("< 404 {")) << session[1];
  EXPECT_EQ(session[2], "x< closes the connection: the client sends no more requests");
}

TEST_F(ControllerClientLogTest, ShowsWhoEndsConnections)
{
  RtdeClient killed(address());
  ASSERT_TRUE(killed.negotiate(2));
  killed.socket().reset();
  ASSERT_TRUE(wait_for_clients("rtde", 0));
  const DashboardClient dropped(address());
  controller->control({{"command", "drop_links"}, {"which", "dashboard"}});
  const DashboardClient reset(address());
  controller->control({{"command", "drop_links"}, {"which", "dashboard"}, {"reset", true}});
  const DashboardClient powered_off(address());
  controller->control({{"command", "reboot"}});
  const Lines lines = finish();
  EXPECT_EQ(lines_with(lines, "RTDE client 1-x"), Lines{"RTDE client 1-xrobot: Connection reset by peer"});
  EXPECT_EQ(lines_with(lines, "robot--x"),
            (Lines{"robot--xdashboard client 1: closes the connection: drop_links",
                   "robot--xdashboard client 1: closes the connection: reset",
                   "robot--xdashboard client 1: closes the connection: reset"}));
}

TEST_F(ControllerClientLogTest, ShowsRefusedConnections)
{
  std::vector<std::unique_ptr<DashboardClient>> clients;
  for (int i = 0; i < 50; ++i) {
    clients.push_back(std::make_unique<DashboardClient>(address()));
  }
  TcpClient rejected(address(), 29999);
  EXPECT_TRUE(rejected.closed_by_peer());
  EXPECT_EQ(lines_with(finish(), "too many"),
            Lines{"robot--xdashboard client 51: closes the connection: too many clients"});
}

TEST_F(ControllerClientLogTest, LimitsFloods)
{
  constexpr int requests = 20000;
  DashboardClient client(address());
  std::string block;
  for (int i = 0; i < 100; ++i) {
    block += "robotmode\n";
  }
  for (int i = 0; i < requests / 100; ++i) {
    client.socket().send(block);
    for (int reply = 0; reply < 100; ++reply) {
      client.socket().receive_line();
    }
  }
  const double seconds_of_robot = controller->state()["timestamp"];
  const Lines lines = finish();
  const auto shown = session_of(lines, "dashboard client 1").size();
  EXPECT_GE(shown, 200u);
  EXPECT_LE(static_cast<double>(shown), 2.0 * (200.0 + 20.0 * seconds_of_robot));  // with the notes
  EXPECT_FALSE(lines_with(lines, " lines left out: there were more than 20 per second").empty());
}

}  // namespace
}  // namespace ur_simulator::testing
