#include <gtest/gtest.h>

#include "connection/retry_delay.hpp"

namespace ur_ros_rtde::test {
namespace {

using namespace std::chrono_literals;

struct RetryDelayTest : testing::Test {
  RetryDelay::Clock::time_point begin{1h};

  /// Number of attempts during an outage of this duration, if the controller rejects each of them at once.
  int attempts(std::chrono::milliseconds outage) const
  {
    const RetryDelay delay(250ms, begin);
    int count = 0;
    for (auto now = begin; now < begin + outage; now += delay.after_refusal(now)) {
      ++count;
    }
    return count;
  }
};

TEST_F(RetryDelayTest, IsOnePercentOfTheOutageWithinItsLimits)
{
  const RetryDelay delay(250ms, begin);
  EXPECT_EQ(delay.after_refusal(begin), 10ms);
  EXPECT_EQ(delay.after_refusal(begin + 1s), 10ms);
  EXPECT_EQ(delay.after_refusal(begin + 3s), 30ms);
  EXPECT_EQ(delay.after_refusal(begin + 25s), 250ms);
  EXPECT_EQ(delay.after_refusal(begin + 1h), 250ms);
}

TEST_F(RetryDelayTest, BoundsTheNumberOfAttempts)
{
  EXPECT_EQ(attempts(1s), 100);
  EXPECT_LT(attempts(25s), 450);
  EXPECT_LE(attempts(125s) - attempts(25s), 401);
}

TEST_F(RetryDelayTest, IsTheLongestOneAfterAnswersOfAnotherService)
{
  EXPECT_EQ(RetryDelay(250ms, begin).after_failure(), 250ms);
}

TEST_F(RetryDelayTest, IsZeroAfterTheLossOfALastingConnection)
{
  RetryDelay delay(250ms, begin);
  EXPECT_EQ(delay.after_loss(begin + 60s, begin + 61s), 0ms);
  EXPECT_EQ(delay.outage(begin + 61s), 0ms);
  EXPECT_EQ(delay.after_refusal(begin + 61s), 10ms) << "a new outage";
}

TEST_F(RetryDelayTest, IsTheLongestOneIfConnectionsBreakAgainAndAgain)
{
  RetryDelay delay(250ms, begin);
  EXPECT_EQ(delay.after_loss(begin + 60s, begin + 60s + 249ms), 250ms);
}

TEST_F(RetryDelayTest, ReportsAnOutageAfterTheLongestDelay)
{
  RetryDelay delay(250ms, begin);
  EXPECT_FALSE(delay.worth_reporting(begin + 249ms));
  EXPECT_TRUE(delay.worth_reporting(begin + 250ms));
  EXPECT_EQ(delay.text(), "Trying again after at most 0.25 s");
  delay.after_loss(begin + 1s, begin + 2s);
  EXPECT_FALSE(delay.worth_reporting(begin + 2s));
}

TEST_F(RetryDelayTest, NeverExceedsAShortLimit)
{
  const RetryDelay delay(1ms, begin);
  EXPECT_EQ(delay.after_refusal(begin), 1ms);
  EXPECT_EQ(delay.after_refusal(begin + 1h), 1ms);
}

}  // namespace
}  // namespace ur_ros_rtde::test
