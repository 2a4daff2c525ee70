// The pace of setpoints of servoJ, by which the target catches up after a bunch of them.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {
namespace {

Sample with_ahead(double cycles)
{
  Sample sample{};
  sample.output_double_registers[0] = cycles;
  return sample;
}

TEST(ServoPaceTest, IsFullWhileTheTargetIsNotBehind)
{
  for (const double ahead : {4.0, 0.0, -1.0}) {
    EXPECT_EQ(with_ahead(ahead).servo_pace(), 1.0) << ahead;
  }
  EXPECT_EQ(with_ahead(std::numeric_limits<double>::quiet_NaN()).servo_pace(), 1.0) << "not provided";
}

TEST(ServoPaceTest, LetsTheTargetCatchUpWithoutOvershoot)
{
  // The register is a few cycles old when the setpoint that answers it arrives.
  constexpr std::size_t delay = 4;
  std::vector<double> ahead(delay, -60.0);
  for (int cycle = 0; cycle < 300; ++cycle) {
    const double pace = with_ahead(ahead[ahead.size() - delay]).servo_pace();
    ASSERT_GE(pace, 0.5);
    ahead.push_back(ahead.back() + 1.0 - pace);
    ASSERT_LT(ahead.back(), 0.0) << "the target waits for setpoints";
  }
  EXPECT_GT(ahead.back(), -1.1);
}

TEST(ServoPaceTest, HasToBeFullAtTheEndOfAPlanForALimitedTime)
{
  EXPECT_FALSE(with_ahead(0.0).servo_is_at_end(-0.01));
  EXPECT_TRUE(with_ahead(0.0).servo_is_at_end(0.0));
  EXPECT_FALSE(with_ahead(-2.0).servo_is_at_end(0.5));
  EXPECT_TRUE(with_ahead(-2.0).servo_is_at_end(1.1)) << "the register belongs to someone else";
}

}  // namespace
}  // namespace ur_ros_rtde
