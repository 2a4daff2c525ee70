#include <optional>

#include "client_log/client_log.hpp"
#include "support/sequence_diagram.hpp"
#include "support/temporary_file.hpp"

namespace ur_simulator::testing {
namespace {

class ClientLogTest : public ::testing::Test {
 protected:
  /// Ends the log and returns its lines.
  std::vector<std::string> finish()
  {
    log.reset();
    writer.reset();
    return read_diagram(file.path());
  }

  TemporaryFile file{"client_log"};
  double time = 0.0;
  std::optional<DiagramWriter> writer{std::in_place, file.path()};
  std::optional<ClientLog> log{std::in_place, *writer, time};
};

TEST_F(ClientLogTest, ShowsMessagesNotesAndEnds)
{
  {
    const PeerLog client = log->add_peer("dashboard client");
    client.from_peer("{}", "robotmode");
    client.to_peer("Robotmode: {}", "RUNNING");
    client.note("nothing happens");
    client.closed_by_peer("closes the connection");
    client.closed_by_robot("too late");
  }
  log->add_event("safety: stop");
  EXPECT_EQ(finish(), (std::vector<std::string>{"dashboard client 1->>robot: robotmode",
                                                "robot-->>dashboard client 1: Robotmode: RUNNING",
                                                "Note over robot,dashboard client 1: nothing happens",
                                                "dashboard client 1-xrobot: closes the connection",
                                                "robot--xdashboard client 1: closes the connection: too late",
                                                "Note over robot: safety: stop"}));
}

TEST_F(ClientLogTest, WritesSimulatedTime)
{
  time = 12.3456;
  log->add_event("event");
  log.reset();
  writer.reset();
  std::ifstream text(file.path());
  std::string line;
  while (std::getline(text, line) && !line.starts_with("Note")) {
  }
  EXPECT_EQ(line, "Note over robot: [12.346] event");
}

TEST_F(ClientLogTest, UsesLowestFreeNumber)
{
  {
    const PeerLog first = log->add_peer("RTDE client");
    std::optional<PeerLog> second = log->add_peer("RTDE client");
    const PeerLog other = log->add_peer("host");
    const PeerLog third = log->add_peer("RTDE client");
    second.reset();
    log->add_peer("RTDE client").from_peer("again");
    third.from_peer("third");
    other.from_peer("other");
  }
  EXPECT_EQ(finish(), (std::vector<std::string>{"RTDE client 2->>robot: again",
                                                "RTDE client 3->>robot: third", "host 1->>robot: other"}));
}

TEST_F(ClientLogTest, ContainsTextsOfClients)
{
  const std::string nasty = "x\nend; participant y %%{init: {\"theme\": \"dark\"}}%% <br> \x1b[2J #35; $$x$$";
  log->add_peer("client").from_peer("{}", nasty);
  log->add_peer("client").from_peer("{}", std::string(1000, ';'));
  const std::vector<std::string> lines = finish();  // checks their form
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("x\\nend#59; participant y"), std::string::npos);
  EXPECT_TRUE(lines[1].ends_with("#59; ... (700 more bytes)"));
}

TEST_F(ClientLogTest, LimitsLinesOfEachParticipant)
{
  const auto send = [](const PeerLog & peer, int count) {
    for (int i = 0; i < count; ++i) {
      peer.from_peer("request");
    }
  };
  {
    const PeerLog flood = log->add_peer("flood");
    const PeerLog calm = log->add_peer("calm");
    send(flood, 1000);
    send(calm, 1);
    time = 1.0;
    send(flood, 1000);
  }
  const std::vector<std::string> lines = finish();
  EXPECT_EQ(lines_with(lines, "flood 1->>robot").size(), 220u);  // 200 at once, 20 per second
  EXPECT_EQ(lines_with(lines, "calm 1->>robot").size(), 1u);
  EXPECT_EQ(lines_with(lines, "left out"),
            (std::vector<std::string>{
                "Note over robot,flood 1: 800 lines left out: there were more than 20 per second",
                "Note over robot,flood 1: 980 lines left out: there were more than 20 per second"}));
}

TEST(ClientLogOfSeveralRobotsTest, NamesRobots)
{
  const TemporaryFile file("several");
  const double time = 0.0;
  {
    DiagramWriter writer(file.path());
    ClientLog first(writer, time, "127.0.0.1");
    ClientLog second(writer, time, "127.0.0.2");
    first.add_peer("RTDE client").from_peer("start");
    second.add_peer("RTDE client").from_peer("start");
  }
  EXPECT_EQ(read_diagram(file.path()),
            (std::vector<std::string>{"RTDE client 1 of 127.0.0.1->>robot 127.0.0.1: start",
                                      "RTDE client 1 of 127.0.0.2->>robot 127.0.0.2: start"}));
}

TEST(PeerLogTest, DoesNothingWithoutLog)
{
  const PeerLog none;
  none.from_peer("request {}", 1);
  none.closed_by_peer("closes the connection");
  EXPECT_FALSE(none);
}

TEST(RateLimitTest, AllowsBurstAndThenRate)
{
  RateLimit limit(2.0, 10.0);
  EXPECT_TRUE(limit.take(5.0));
  EXPECT_TRUE(limit.take(5.0));
  EXPECT_FALSE(limit.take(5.05));
  EXPECT_TRUE(limit.take(5.11));
  EXPECT_FALSE(limit.take(1.0));  // the clock was set back
  EXPECT_TRUE(limit.take(1.11));
}

}  // namespace
}  // namespace ur_simulator::testing
