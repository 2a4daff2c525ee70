#include "support/dashboard_client.hpp"
#include "support/simulator_test.hpp"
#include "support/tcp_client.hpp"

namespace ur_simulator::testing {
namespace {

class OperationalModeTest : public SimulatorTest {
 protected:
  DashboardClient client{controller.address()};
};

TEST_F(OperationalModeTest, IsSetQueriedAndCleared)
{
  EXPECT_EQ(client.request("get operational mode"), "NONE");
  EXPECT_EQ(client.request("set operational mode manual"), "Operational mode 'manual' is set");
  EXPECT_EQ(client.request("get operational mode"), "MANUAL");
  EXPECT_EQ(client.request("set operational mode automatic"), "Operational mode 'automatic' is set");
  EXPECT_EQ(client.request("set operational mode sleepy"), "Failed setting operational mode: sleepy");
  EXPECT_EQ(client.request("clear operational mode").substr(0, 42),
            "No longer controlling the operational mode");
  EXPECT_EQ(client.request("get operational mode"), "NONE");
}

TEST_F(OperationalModeTest, ManualModeRejectsRemoteStart)
{
  controller.control({{"command", "store_program"},
                      {"name", "wait.urp"},
                      {"script", "def wait():\n while True:\n  sync()\n end\nend\n"},
                      {"load", true}});
  EXPECT_EQ(client.request("set operational mode manual"), "Operational mode 'manual' is set");
  EXPECT_EQ(client.request("play"), "Failed to execute: play");
  TcpClient script(controller.address(), 30002);
  script.send("def mine():\n while True:\n  sync()\n end\nend\n");
  EXPECT_TRUE(wait_for_log(controller, "script was not started: the operational mode"));
  EXPECT_EQ(client.request("running"), "Program running: false");
  EXPECT_EQ(client.request("clear operational mode").substr(0, 2), "No");
  EXPECT_EQ(client.request("play"), "Starting program");
}

}  // namespace
}  // namespace ur_simulator::testing
