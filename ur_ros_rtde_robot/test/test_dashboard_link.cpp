#include <gtest/gtest.h>
#include <ur_rtde/dashboard_client.h>

#include <atomic>

#include "support.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_link.hpp"

namespace ur_ros_rtde::test {
namespace {

struct ADashboardLink : testing::Test {
  Log log;
  Controller controller;
  std::atomic<int> lost = 0;
  std::unique_ptr<DashboardLink> link;

  void connect()
  {
    DashboardLinkOptions options;
    options.address = own_address();
    options.retry_interval = 50ms;
    options.heartbeat = 50ms;
    link = std::make_unique<DashboardLink>(options, log.function());
    link->on_link([this](const LinkStatus & status) { lost += status.connected ? 0 : 1; });
    link->start();
  }
  bool connected() const
  {
    return eventually([this] { return link->link().connected; });
  }
};

TEST_F(ADashboardLink, comes_up_with_a_controller_that_comes_later)
{
  connect();
  ASSERT_TRUE(eventually([&] { return log.count(own_address() + ":29999") == 1; })) << log.text();
  EXPECT_THROW(link->dashboard(), RobotError);
  controller.start();
  ASSERT_TRUE(connected()) << log.text();
  EXPECT_NE(link->dashboard()->robotmode().find("RUNNING"), std::string::npos);
}

TEST_F(ADashboardLink, gives_the_robots_refusal_as_an_error)
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

TEST_F(ADashboardLink, is_made_anew_at_once_when_the_robot_closes_it)
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

TEST_F(ADashboardLink, tells_that_it_is_lost_when_the_robot_takes_no_new_one)
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

TEST_F(ADashboardLink, fails_a_call_that_finds_the_connection_dropped_and_makes_it_anew)
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

TEST_F(ADashboardLink, knows_whether_the_robot_is_in_remote_control)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  EXPECT_EQ(link->in_remote_control(), true);
  controller.control({{"command", "remote_control"}, {"on", false}});
  EXPECT_TRUE(eventually([&] { return link->in_remote_control() == false; }));
}

TEST_F(ADashboardLink, is_made_anew_when_answers_do_not_fit_their_questions)
{
  controller.start();
  connect();
  ASSERT_TRUE(connected());
  controller.control({{"command", "send_garbage"}, {"which", "dashboard"}, {"bytes", 600}});
  ASSERT_TRUE(eventually([&] { return log.count("was answered") == 1; })) << log.text();
  ASSERT_TRUE(connected()) << log.text();
  EXPECT_EQ(link->in_remote_control(), true);
}

TEST_F(ADashboardLink, recognises_a_service_of_another_kind)
{
  const OtherService other(29999, "220 mail.example.org ESMTP\r\n");
  connect();
  EXPECT_TRUE(eventually([&] { return log.count("does not greet as a UR dashboard server") == 1; }))
      << log.text();
}

}  // namespace
}  // namespace ur_ros_rtde::test
