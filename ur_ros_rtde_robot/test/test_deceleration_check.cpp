#include <gtest/gtest.h>

#include "motion/deceleration_check.hpp"

namespace ur_ros_rtde {
namespace {

Sample sample(double time, double joint, double tcp = 0.0)
{
  Sample result{};
  result.controller_time = time;
  result.target_qd[2] = joint;
  result.target_tcp_speed[0] = tcp;
  return result;
}

/// Time at which the check fails for an arm with this motion, within a second. Empty: not.
template <typename Joint, typename Tcp>
std::optional<double> fails_at(Joint joint, Tcp tcp)
{
  DecelerationCheck check;
  for (double time = 0.0; time < 1.0; time += 0.002) {
    if (!check.add(sample(time, joint(time), tcp(time)))) {
      return time;
    }
  }
  return std::nullopt;
}

constexpr auto none = [](double) { return 0.0; };

TEST(DecelerationCheckTest, AcceptsTheGentlestStop)
{
  EXPECT_FALSE(fails_at([](double time) { return 0.5 - 0.001 * time; }, none));
}

TEST(DecelerationCheckTest, AcceptsAnArmAtRest)
{
  EXPECT_FALSE(fails_at(none, none));
}

TEST(DecelerationCheckTest, AcceptsALinearStopInWhichAJointBecomesFaster)
{
  EXPECT_FALSE(
      fails_at([](double time) { return 0.5 + time; }, [](double time) { return 0.2 - 0.1 * time; }));
}

TEST(DecelerationCheckTest, FailsIfTheArmKeepsItsSpeed)
{
  const auto time = fails_at([](double) { return 0.5; }, [](double) { return 0.2; });
  ASSERT_TRUE(time);
  EXPECT_LE(*time, DecelerationCheck::window + 0.0021);
}

TEST(DecelerationCheckTest, FailsIfTheArmBecomesFasterAgain)
{
  const auto time = fails_at([](double t) { return t < 0.3 ? 0.5 - t : 0.2 + t; }, none);
  ASSERT_TRUE(time);
  EXPECT_LE(*time, 0.3 + 2 * DecelerationCheck::window + 0.0021);
}

TEST(DecelerationCheckTest, FailsWithoutSpeeds)
{
  EXPECT_TRUE(fails_at([](double) { return std::nan(""); }, [](double) { return std::nan(""); }));
}

}  // namespace
}  // namespace ur_ros_rtde
