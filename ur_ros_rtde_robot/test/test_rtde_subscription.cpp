#include <gtest/gtest.h>

#include <cmath>

#include "connection/dashboard_request.hpp"
#include "support.hpp"
#include "ur_ros_rtde_robot/connection/dashboard_session.hpp"
#include "ur_ros_rtde_robot/connection/rtde_subscription.hpp"
#include "ur_ros_rtde_robot/state/rtde_outputs.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = RtdeSubscription::Clock;
constexpr std::chrono::milliseconds timeout{2000};

struct RtdeSubscriptionTest : testing::Test {
  Controller controller;

  Expected<RtdeSubscription> open(const std::vector<std::string> & fields, double frequency = 0.0)
  {
    return RtdeSubscription::open(own_address(), fields, frequency, timeout);
  }
};

TEST_F(RtdeSubscriptionTest, ReturnsFieldsOfEveryTypeInTheRequestedOrder)
{
  controller.start();
  const auto q = controller.state()["actual"]["position"].get<std::vector<double>>();
  controller.control({{"command", "set_digital_input"}, {"number", 17}, {"value", true}});
  auto subscription = open({"robot_mode", "actual_q", "tool_output_mode", "actual_digital_input_bits",
                            "actual_tool_accelerometer", "input_bit_register_64", "joint_mode", "timestamp"});
  ASSERT_TRUE(subscription) << subscription.error().message;
  EXPECT_EQ(subscription->width(), 1U + 6 + 1 + 1 + 3 + 1 + 6 + 1);
  EXPECT_EQ(subscription->fields()[4].name, "actual_tool_accelerometer");
  EXPECT_EQ(subscription->fields()[4].size, 3U);
  std::vector<double> numbers(subscription->width());
  ASSERT_TRUE(subscription->next(numbers, Clock::now() + timeout).value_or(false));
  EXPECT_EQ(numbers[0], 7.0);  // RUNNING
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(numbers[1 + i], q[i], 1e-3);
    EXPECT_EQ(numbers[13 + i], 253.0);  // JOINT_MODE_RUNNING
  }
  EXPECT_EQ(numbers[8], std::ldexp(1.0, 17));
  EXPECT_EQ(numbers[12], 0.0);
}

TEST_F(RtdeSubscriptionTest, TheLimitOfSilenceFollowsALowFrequency)
{
  controller.start();
  using namespace std::chrono_literals;
  const auto slow = open({"timestamp"}, 1.0);
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->silence_limit(500ms), 5s);
  const auto fast = open({"timestamp"}, 125.0);
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->silence_limit(500ms), 500ms);
}

TEST_F(RtdeSubscriptionTest, ReturnsOnePackagePerCycle)
{
  controller.start();
  auto subscription = open({"timestamp"}, 125.0);
  ASSERT_TRUE(subscription);
  EXPECT_EQ(subscription->frequency(), 125.0);
  std::vector<double> now(1);
  std::vector<double> before(1);
  ASSERT_TRUE(subscription->next(before, Clock::now() + timeout).value_or(false));
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(subscription->next(now, Clock::now() + timeout).value_or(false));
    EXPECT_NEAR(now[0] - before[0], 0.008, 1e-6);
    before = now;
  }
}

TEST_F(RtdeSubscriptionTest, LimitsTheFrequencyToTheControllersMaximum)
{
  controller.start();
  const auto subscription = open({"timestamp"}, 2000.0);
  ASSERT_TRUE(subscription);
  EXPECT_EQ(subscription->frequency(), 500.0);
}

TEST_F(RtdeSubscriptionTest, NamesTheFieldsThatTheControllerLacks)
{
  controller.start();
  const auto subscription = open({"actual_q", "actual_moment", "encoder9_raw"});
  ASSERT_FALSE(subscription);
  EXPECT_EQ(subscription.error().code, ErrorCode::not_supported);
  EXPECT_NE(subscription.error().message.find("actual_moment, encoder9_raw"), std::string::npos)
      << subscription.error().message;
}

TEST_F(RtdeSubscriptionTest, ReportsALostConnectionAndSilence)
{
  controller.start();
  auto subscription = open({"timestamp"});
  ASSERT_TRUE(subscription);
  std::vector<double> numbers(1);
  ASSERT_TRUE(subscription->next(numbers, Clock::now() + timeout).value_or(false));
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  EXPECT_TRUE(eventually([&] { return !subscription->next(numbers, Clock::now() + 100ms).value_or(true); }));
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  EXPECT_TRUE(eventually([&] { return !subscription->next(numbers, Clock::now() + 100ms); }));
}

TEST_F(RtdeSubscriptionTest, RejectsAnotherService)
{
  const OtherService other(30004, "220 mail.example.org ESMTP\r\n");
  const auto subscription = open({"timestamp"});
  ASSERT_FALSE(subscription);
  EXPECT_EQ(subscription.error().code, ErrorCode::link_lost);
}

TEST_F(RtdeSubscriptionTest, EndsAtItsLimitDuringAFloodOfTextMessages)
{
  constexpr std::size_t messages = 10'000'000;
  std::string flood;
  flood.reserve(4 * messages);
  for (std::size_t i = 0; i < messages; ++i) {
    flood.append("\0\4Mx", 4);
  }
  const OtherService other(30004, std::move(flood));
  const auto begin = Clock::now();
  const auto subscription = RtdeSubscription::open(own_address(), {"timestamp"}, 0.0, 300ms);
  ASSERT_FALSE(subscription);
  EXPECT_EQ(subscription.error().code, ErrorCode::link_lost);
  EXPECT_LT(Clock::now() - begin, 3s);
}

TEST(RtdeOutputsTest, AreKnownByName)
{
  for (const char * name : {"timestamp", "actual_TCP_pose", "output_int_register_0",
                            "output_bit_register_127", "input_double_register_47"}) {
    EXPECT_TRUE(is_rtde_output(name)) << name;
  }
  for (const char * name :
       {"", "Timestamp", "actual_tcp_pose", "output_int_register_48", "output_int_register_",
        "output_int_register_01", "output_int_register_-1", "output_bit_register_63"}) {
    EXPECT_FALSE(is_rtde_output(name)) << name;
  }
}

struct DashboardRequestTest : testing::Test {
  Controller controller;
  Expected<std::string> send(const std::string & line, std::chrono::milliseconds patience = timeout)
  {
    return dashboard_request(own_address(), line, patience, {});
  }
};

TEST_F(DashboardRequestTest, ReturnsTheAnswerWithoutTheLineEnd)
{
  controller.start();
  EXPECT_EQ(send("robotmode").value_or("nothing"), "Robotmode: RUNNING");
}

TEST_F(DashboardRequestTest, UsesTheCurrentControlMode)
{
  controller.start();
  controller.control({{"command", "remote_control"}, {"on", false}});
  EXPECT_NE(send("power off").value_or("").find("Remote Control"), std::string::npos);
  controller.control({{"command", "remote_control"}, {"on", true}});
  EXPECT_EQ(send("power off").value_or("nothing"), "Powering off");
}

TEST_F(DashboardRequestTest, EndsAtItsLimitAndWhenStopped)
{
  const OtherService silent(29999, "Connected: Universal Robots Dashboard Server\n");
  const auto late = send("robotmode", 200ms);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::timeout);
  std::stop_source stop;
  const std::jthread stopper([&] { stop.request_stop(); });
  const auto stopped = dashboard_request(own_address(), "robotmode", 60s, stop.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::canceled);
}

/// A busy controller greets late.
TEST_F(DashboardRequestTest, SendsTheLineBeforeTheGreeting)
{
  const OtherService late(29999, "Connected: Universal Robots Dashboard Server\nStopped\n", true);
  EXPECT_EQ(send("stop").value_or("nothing"), "Stopped");
}

TEST_F(DashboardRequestTest, ASessionUsesOneConnection)
{
  controller.start();
  const auto drop_connections = [&] {
    return controller.control({{"command", "drop_links"}, {"which", "dashboard"}}).at("connections");
  };
  DashboardSession session(own_address());
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(session.request("robotmode", timeout).value_or("nothing"), "Robotmode: RUNNING");
  }
  EXPECT_EQ(drop_connections(), 1);
  EXPECT_EQ(session.request("robotmode", timeout).value_or("nothing"), "Robotmode: RUNNING");
  EXPECT_EQ(drop_connections(), 1);
}

TEST_F(DashboardRequestTest, ReportsAMissingServer)
{
  const auto answer = send("robotmode");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::link_lost);
}

}  // namespace
}  // namespace ur_ros_rtde::test
