#include <gtest/gtest.h>
#include <ur_rtde/dashboard_client.h>

#include <atomic>
#include <boost/system/system_error.hpp>

#include "connection/ports.hpp"
#include "reply_server.hpp"
#include "support.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_connection.hpp"

namespace ur_ros_rtde::test {
namespace {

struct DashboardConnectionTest : testing::Test {
  Log log;
  Controller controller;
  std::atomic<int> lost = 0;
  std::unique_ptr<DashboardConnection> link;

  void connect(std::chrono::milliseconds retry_interval = 50ms)
  {
    DashboardConnectionOptions options;
    options.address = own_address();
    options.retry_interval = retry_interval;
    options.heartbeat = 50ms;
    link = std::make_unique<DashboardConnection>(options, log.function());
    link->on_link([this](const LinkStatus & status) { lost += status.connected ? 0 : 1; });
    link->start();
  }
  bool connected() const
  {
    return eventually([this] { return link->link().connected; });
  }
};

TEST(DashboardReplyTest, VersionsInLongRepliesAreRead)
{
  ur_fuzz::ReplyServer server(own_address(), dashboard_port);
  server.set_reply("Connected\nURSoftware 5.25.1.0 " + std::string(60000, '1') + "\n" +
                   std::string(60000, '1') + "\n" + std::string(60000, '.') + "\n");
  ur_rtde::DashboardClient client(own_address());
  client.connect();
  EXPECT_EQ(client.polyscopeVersion(), "5.25.1.0");
  EXPECT_EQ(client.polyscopeVersion(), std::string(256, '1'));
  EXPECT_THROW(client.isInRemoteControl(), std::runtime_error);
}

TEST(DashboardReplyTest, RepliesWithoutEndAreRejected)
{
  ur_fuzz::ReplyServer server(own_address(), dashboard_port);
  server.set_reply("Connected\n" + std::string(70000, 'x') + "\n");
  ur_rtde::DashboardClient client(own_address());
  client.connect();
  EXPECT_THROW(client.robotmode(), boost::system::system_error);
}

TEST_F(DashboardConnectionTest, ConnectsToAControllerThatStartsLater)
{
  connect();
  ASSERT_TRUE(eventually([&] { return log.count(own_address() + ":29999") == 1; })) << log.text();
  EXPECT_THROW(link->dashboard(), RobotError);
  controller.start();
  ASSERT_TRUE(connected()) << log.text();
  EXPECT_NE(link->dashboard()->robotmode().find("RUNNING"), std::string::npos);
}

TEST_F(DashboardConnectionTest, ConnectsSoonAfterTheControllerHasStarted)
{
  connect(60s);  // the delay is 1 % of the outage
  ASSERT_TRUE(eventually([&] { return link->link().error.message.find("no connection") == 0; }))
      << link->link().error.message;
  controller.start();
  EXPECT_TRUE(connected()) << log.text();
}

TEST_F(DashboardConnectionTest, ReturnsTheRobotsRejectionAsAnError)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  const auto status = link->call([](ur_rtde::DashboardClient & client) { client.loadURP("nowhere.urp"); });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::rejected_by_robot);
  EXPECT_NE(status.error().message.find("nowhere.urp"), std::string::npos) << status.error().message;
  EXPECT_TRUE(link->call([](ur_rtde::DashboardClient & client) { client.robotmode(); }));
}

TEST_F(DashboardConnectionTest, ReconnectsAtOnceWhenTheRobotClosesTheConnection)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  controller.control({{"command", "drop_links"}, {"which", "dashboard"}});
  ASSERT_TRUE(eventually([&] { return log.count("connected again") == 1; })) << log.text();
  EXPECT_TRUE(eventually([&] {
    return !!link->call([](ur_rtde::DashboardClient & client) { client.robotmode(); });
  })) << log.text();
  EXPECT_EQ(lost, 0);
}

TEST_F(DashboardConnectionTest, ReportsTheLossWhenTheRobotRefusesANewConnection)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  controller.control({{"command", "refuse_connections"}, {"which", "dashboard"}});
  controller.control({{"command", "drop_links"}, {"which", "dashboard"}});
  ASSERT_TRUE(eventually([&] { return !link->link().connected; })) << log.text();
  controller.control({{"command", "accept_connections"}});
  EXPECT_TRUE(connected()) << log.text();
}

TEST_F(DashboardConnectionTest, FailsACallOnADroppedConnectionAndReconnects)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  controller.control({{"command", "drop_links"}, {"which", "dashboard"}});
  eventually([&] { return !link->call([](ur_rtde::DashboardClient & client) { client.robotmode(); }); }, 1s);
  EXPECT_TRUE(eventually([&] {
    return !!link->call([](ur_rtde::DashboardClient & client) { client.robotmode(); });
  })) << log.text();
}

TEST_F(DashboardConnectionTest, ReportsRemoteControl)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  EXPECT_EQ(link->in_remote_control(), true);
  controller.control({{"command", "remote_control"}, {"on", false}});
  EXPECT_TRUE(eventually([&] { return link->in_remote_control() == false; }));
}

TEST_F(DashboardConnectionTest, ReconnectsWhenAnswersDoNotMatchTheQueries)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  controller.control({{"command", "send_garbage"}, {"which", "dashboard"}, {"bytes", 600}});
  ASSERT_TRUE(eventually([&] { return log.count("was answered") == 1; })) << log.text();
  ASSERT_TRUE(connected()) << log.text();
  EXPECT_EQ(link->in_remote_control(), true);
}

TEST_F(DashboardConnectionTest, DetectsAnotherService)
{
  const OtherService other(29999, "220 mail.example.org ESMTP\r\n");
  connect();
  EXPECT_TRUE(eventually([&] { return log.count("does not greet as a UR dashboard server") == 1; }))
      << log.text();
}

}  // namespace
}  // namespace ur_ros_rtde::test
