#include <algorithm>
#include <memory>
#include <vector>

#include "../../fuzz/simulated_robot.hpp"
#include "robot_api/server.hpp"
#include "support/flood.hpp"
#include "support/polyscope_x_test.hpp"
#include "support/rtde_client.hpp"

namespace ur_simulator::testing {
namespace {

constexpr const char * get_mode =
    "GET /universal-robots/robot-api/robotstate/v1/robotmode HTTP/1.1\r\nHost: robot\r\n\r\n";

class RobotApiHttpTest : public PolyscopeXTest {
 protected:
  /// The reply to the bytes as sent by a new client.
  HttpReply reply_to(const std::string & bytes)
  {
    HttpClient other(controller.address(), controller.ports().robot_api);
    other.socket().send(bytes);
    return other.receive();
  }
};

TEST_F(RobotApiHttpTest, AnswersInvalidPathsAndMethods)
{
  EXPECT_EQ(client.get("/no/such/path").status, 404);
  EXPECT_EQ(client.get("/no/such/path").json()["detail"], "Not Found");
  EXPECT_EQ(reply_to("GET / HTTP/1.1\r\nHost: robot\r\n\r\n").status, 404);
  const HttpReply reply = client.request("POST", "/robotstate/v1/state");
  EXPECT_EQ(reply.status, 405);
  EXPECT_EQ(reply.headers.at("allow"), "PUT");
  EXPECT_EQ(client.request("HEAD", "/openapi.json").status, 405);
  EXPECT_EQ(client.get("/robotstate/v1/robotmode?verbose=1").status, 200);
}

TEST_F(RobotApiHttpTest, RedirectsToPathWithOrWithoutSlash)
{
  const HttpReply reply = client.get("/system/v1/system-time/");
  EXPECT_EQ(reply.status, 307);
  EXPECT_EQ(reply.headers.at("location"), "/universal-robots/robot-api/system/v1/system-time");
  EXPECT_EQ(client.get("/programs/v1").headers.at("location"), "/universal-robots/robot-api/programs/v1/");
}

TEST_F(RobotApiHttpTest, NamesInvalidFieldOfBody)
{
  const auto location = [&](const std::string & body) {
    const HttpReply reply = client.request("PUT", "/robotstate/v1/state", body);
    EXPECT_EQ(reply.status, 422) << body;
    return reply.json()["detail"][0]["loc"];
  };
  EXPECT_EQ(location("no JSON"), json({"body"}));
  EXPECT_EQ(location(""), json({"body"}));
  EXPECT_EQ(location("[1]"), json({"body"}));
  EXPECT_EQ(location("{}"), json({"body", "action"}));
  EXPECT_EQ(location(R"({"action": 1})"), json({"body", "action"}));
  EXPECT_EQ(location(R"({"action": "DANCE"})"), json({"body", "action"}));
}

TEST_F(RobotApiHttpTest, DescribesItself)
{
  const json document = client.get("/openapi.json").json();
  EXPECT_EQ(document["info"]["version"], "5.0.107");
  const json & schema = document["paths"]["/robotstate/v1/state"]["put"]["requestBody"]["content"]
                                ["application/json"]["schema"];
  EXPECT_EQ(schema["required"], json({"action"}));
  EXPECT_EQ(schema["properties"]["action"]["enum"][0], "POWER_ON");
  EXPECT_TRUE(document["paths"]["/programs/v1/{name}"].contains("get"));
}

TEST_F(RobotApiHttpTest, RejectsMalformedAndOversizedRequests)
{
  EXPECT_EQ(reply_to("this is not HTTP\r\n\r\n").status, 400);
  EXPECT_EQ(reply_to(std::string("\x16\x03\x01\x02", 4) + std::string(200, '\x01') + "\r\n\r\n").status, 400);
  EXPECT_EQ(reply_to("PUT / HTTP/1.1\r\nContent-Length: many\r\n\r\n").status, 400);
  EXPECT_EQ(reply_to("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n").status, 431);
  EXPECT_EQ(reply_to("PUT / HTTP/1.1\r\nContent-Length: 2000000000\r\n\r\nxxx").status, 413);
  EXPECT_EQ(client.get("/robotstate/v1/robotmode").status, 200);
}

TEST_F(RobotApiHttpTest, RejectedClientThatKeepsSendingReceivesReply)
{
  client.socket().send("PUT /x HTTP/1.1\r\nContent-Length: 8000000\r\n\r\n");
  for (int i = 0; i < 16; ++i) {
    client.socket().send(std::string(65536, 'x'));
  }
  EXPECT_EQ(client.receive().status, 413);
  EXPECT_TRUE(client.socket().closed_by_peer());
}

TEST_F(RobotApiHttpTest, ServesRequestsInPiecesAndPipelined)
{
  const std::string bytes = std::string(get_mode) + get_mode;
  std::for_each(bytes.begin(), bytes.end(), [&](char byte) { client.socket().send({&byte, 1}); });
  EXPECT_EQ(client.receive().json()["mode"], "RUNNING");
  EXPECT_EQ(client.receive().json()["mode"], "RUNNING");
}

TEST_F(RobotApiHttpTest, AcceptsChunkedBodies)
{
  const HttpReply reply = reply_to(
      "POST /universal-robots/robot-api/system/v1/log HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"
      "5\r\n{\"mes\r\nc\r\nsage\":\"hello\r\n2\r\n\"}\r\n0\r\n\r\n");
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_TRUE(log_contains(controller, "hello"));
}

TEST_F(RobotApiHttpTest, AnswersExpectContinue)
{
  client.socket().send(
      "POST /universal-robots/robot-api/system/v1/log HTTP/1.1\r\nExpect: 100-continue\r\nContent-Length: "
      "17\r\n\r\n");
  EXPECT_EQ(client.receive().status, 100);
  client.socket().send(R"({"message":"abc"})");
  EXPECT_EQ(client.receive().status, 200);
}

TEST_F(RobotApiHttpTest, ClosesAfterReplyIfClientAsksForIt)
{
  for (const char * request : {"GET /x HTTP/1.0\r\n\r\n", "GET /x HTTP/1.1\r\nConnection: close\r\n\r\n"}) {
    HttpClient other(controller.address(), controller.ports().robot_api);
    other.socket().send(request);
    EXPECT_EQ(other.receive().status, 404);
    EXPECT_TRUE(other.socket().closed_by_peer());
  }
}

TEST_F(RobotApiHttpTest, RepliesToHalfClosedConnection)
{
  ASSERT_EQ(client.put("/robotstate/v1/state", {{"action", "POWER_OFF"}}).status, 200);
  HttpClient other(controller.address(), controller.ports().robot_api);
  other.socket().send(
      "PUT /universal-robots/robot-api/robotstate/v1/state HTTP/1.1\r\nContent-Length: 21\r\n\r\n"
      "{\"action\":\"POWER_ON\"}");
  other.socket().shut_down_sending();
  EXPECT_EQ(other.receive().json()["state"], "IDLE");
  EXPECT_TRUE(other.socket().closed_by_peer());
}

TEST_F(RobotApiHttpTest, SurvivesClientsThatLeave)
{
  for (int i = 0; i < 20; ++i) {
    HttpClient leaving(controller.address(), controller.ports().robot_api);
    leaving.socket().send(
        "PUT /universal-robots/robot-api/robotstate/v1/state HTTP/1.1\r\nContent-Length: 22\r\n\r\n"
        "{\"action\":\"POWER_OFF\"}");
    i % 2 == 0 ? leaving.socket().reset() : leaving.socket().shut_down_sending();
  }
  EXPECT_TRUE(wait_for_robot_mode(controller, "POWER_OFF", seconds(20)));
  EXPECT_EQ(client.get("/robotstate/v1/robotmode").json()["mode"], "POWER_OFF");
}

TEST_F(RobotApiHttpTest, ServesManyConnections)
{
  std::vector<std::unique_ptr<HttpClient>> clients;
  for (int i = 0; i < 49; ++i) {  // and the fixture's client
    clients.push_back(std::make_unique<HttpClient>(controller.address(), controller.ports().robot_api));
  }
  for (const auto & each : clients) {
    each->socket().send(get_mode);
  }
  for (const auto & each : clients) {
    EXPECT_EQ(each->receive().status, 200);
  }
  HttpClient excess(controller.address(), controller.ports().robot_api);
  EXPECT_TRUE(excess.socket().closed_by_peer());
}

TEST_F(RobotApiHttpTest, ClientThatNeverReadsDoesNotDelayOthers)
{
  store_program("large", std::string(2 << 20, '#'));
  client.socket().send("GET /universal-robots/robot-api/programs/v1/large HTTP/1.1\r\nHost: robot\r\n\r\n");
  const double before = controller.state()["timestamp"];
  HttpClient other(controller.address(), controller.ports().robot_api);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(other.get("/robotstate/v1/robotmode").status, 200);
  }
  EXPECT_TRUE(wait_for_next_cycle(controller));
  EXPECT_GT(controller.state()["timestamp"].get<double>(), before);
}

TEST_F(RobotApiHttpTest, FloodDoesNotDisturbOthers)
{
  RtdeClient victim(controller.address());
  ASSERT_TRUE(victim.negotiate(2));
  victim.setup_outputs(500.0, "timestamp");
  ASSERT_TRUE(victim.start());
  const auto receive_timestamp = [&] { return decode_double(victim.receive('U').payload.substr(1, 8)); };
  const Flood requests(controller.address(), controller.ports().robot_api, get_mode);
  const Flood invalid(controller.address(), controller.ports().robot_api, "no HTTP\r\n\r\n");
  double previous = receive_timestamp();
  for (int i = 0; i < 250; ++i) {
    const double timestamp = receive_timestamp();
    ASSERT_NEAR(timestamp - previous, 0.002, 1e-9);
    previous = timestamp;
  }
  EXPECT_EQ(client.get("/robotstate/v1/robotmode").status, 200);
}

// The limit is by the host's clock, and a minute on a robot.
TEST(RobotApiLimitsTest, ClosesConnectionWithoutCompleteRequestInTime)
{
  boost::asio::io_context io;
  fuzz::SimulatedRobot robot("ur10e", "10.14.0");
  robot_api::HttpLimits limits;
  limits.request_time = milliseconds(50);
  const std::string address = unique_address();
  robot_api::Server server(io, address, 0, *robot.pendant, limits);
  const auto serve_until = [&](const auto & condition) {
    const auto end = std::chrono::steady_clock::now() + seconds(10);
    while (!condition() && std::chrono::steady_clock::now() < end) {
      io.poll();
      server.cycle();
    }
    return condition();
  };
  TcpClient slow(address, server.listener().port());
  slow.send("GET /universal-robots HT");
  EXPECT_TRUE(serve_until([&] { return server.listener().connection_count() == 1; }));
  EXPECT_TRUE(serve_until([&] { return server.listener().connection_count() == 0; }));
  EXPECT_TRUE(slow.closed_by_peer());
}

}  // namespace
}  // namespace ur_simulator::testing
