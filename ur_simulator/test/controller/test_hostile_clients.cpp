#include <sys/resource.h>

#include <memory>
#include <vector>

#include "support/dashboard_client.hpp"
#include "support/flood.hpp"
#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

/// A client that misbehaves must not disturb the others: an RTDE client still receives a package in each
/// control cycle, in simulated time.
class HostileClientTest : public SimulatorTest {
 protected:
  HostileClientTest()
  {
    victim.negotiate(2);
    victim.setup_outputs(500.0, "timestamp");
    EXPECT_TRUE(victim.start());
  }

  double receive_timestamp() { return decode_double(victim.receive('U').payload.substr(1, 8)); }

  /// Expects `count` packages of consecutive control cycles.
  void expect_consecutive_cycles(int count)
  {
    double previous = receive_timestamp();
    for (int i = 0; i < count; ++i) {
      const double timestamp = receive_timestamp();
      ASSERT_NEAR(timestamp - previous, 0.002, 1e-9);
      previous = timestamp;
    }
  }

  RtdeClient victim{controller.address()};
};

TEST_F(HostileClientTest, FloodsOnEachPort)
{
  const std::string & address = controller.address();
  {
    const Flood dashboard(address, 29999, "robotmode\n");
    const Flood scripts(address, 30002, "no_such_function()\n");
    const Flood packages(address, 30004, RtdeClient::package('Z', "?"));
    const Flood read_only(address, 30013, "def f():\nend\n");
    const Flood requests(address, 30099, "{\"command\": \"state\"}\n");
    expect_consecutive_cycles(250);
  }
  EXPECT_EQ(DashboardClient(address).request("robotmode"), "Robotmode: RUNNING");
}

TEST_F(HostileClientTest, SendsLineWithoutEnd)
{
  // 16 MiB stand for 2 GiB: scripts have at most 4 MiB, the rest is discarded.
  const std::size_t total = 16U << 20U;
  for (const std::uint16_t port : {std::uint16_t{30001}, std::uint16_t{30003}}) {
    const Flood flood(controller.address(), port, "x");
    while (flood.sent() < total) {
      expect_consecutive_cycles(5);
    }
  }
  EXPECT_TRUE(wait_for_log(controller, "was dropped: it is too long"));
}

TEST_F(HostileClientTest, OpensThousandConnections)
{
  rlimit files{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
  files.rlim_cur = files.rlim_max;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  for (const std::uint16_t port : {std::uint16_t{29999}, std::uint16_t{30003}}) {
    std::vector<std::unique_ptr<TcpClient>> clients;
    for (int i = 0; i < 500; ++i) {
      clients.push_back(std::make_unique<TcpClient>(controller.address(), port));
    }
    expect_consecutive_cycles(50);
    EXPECT_TRUE(clients.back()->closed_by_peer()) << port;
    EXPECT_TRUE(clients[100]->closed_by_peer()) << port;
    // The first ones are still served.
    EXPECT_FALSE(clients.front()->receive(1).empty()) << port;
  }
  ASSERT_TRUE(controller.wait_until([](const json & state) { return state["clients"]["dashboard"] == 0; },
                                    seconds(10)));
  EXPECT_EQ(DashboardClient(controller.address()).request("robotmode"), "Robotmode: RUNNING");
}

TEST_F(HostileClientTest, NeverReads)
{
  std::vector<std::unique_ptr<TcpClient>> readers;
  for (const std::uint16_t port : {std::uint16_t{30001}, std::uint16_t{30002}, std::uint16_t{30003}}) {
    readers.push_back(std::make_unique<TcpClient>(controller.address(), port));
  }
  RtdeClient idle(controller.address());
  ASSERT_TRUE(idle.negotiate(2));
  idle.setup_outputs(500.0, "actual_q,actual_qd,actual_TCP_pose,target_q");
  ASSERT_TRUE(idle.start());
  expect_consecutive_cycles(500);
}

TEST_F(HostileClientTest, HalfCloses)
{
  DashboardClient client(controller.address());
  client.socket().send("robotmode\n");
  client.socket().shut_down_sending();
  EXPECT_EQ(client.socket().receive_line(), "Robotmode: RUNNING");
  EXPECT_TRUE(client.socket().closed_by_peer());
  expect_consecutive_cycles(10);
}

TEST_F(HostileClientTest, InvalidPackagesDisconnectTheirSender)
{
  RtdeClient client(controller.address());
  for (int i = 0; i < 101; ++i) {
    client.send('Z', "");
  }
  EXPECT_TRUE(client.socket().closed_by_peer());
  EXPECT_TRUE(log_contains(controller, "sent 101 invalid packages"));
  expect_consecutive_cycles(10);
}

}  // namespace
}  // namespace ur_simulator::testing
