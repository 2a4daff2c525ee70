#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "ur_ros_rtde_robot/motion/setpoint_clock.hpp"

namespace ur_ros_rtde {
namespace {

constexpr double cycle = 0.002;

Sample with_ahead(double cycles)
{
  Sample sample{};
  sample.output_double_registers[0] = cycles;
  return sample;
}

/// Share of a cycle by which the clock advances.
double pace(double ahead)
{
  return SetpointClock(cycle).advance(with_ahead(ahead), cycle) / cycle;
}

SetpointClock after_step(double ahead)
{
  SetpointClock clock(cycle);
  clock.advance(with_ahead(ahead), cycle);
  return clock;
}

/// The controller keeps registers with 32 bits.
TEST(SetpointClockTest, HasTimesThatFitRegistersWhenTheControllerHasRunForWeeks)
{
  SetpointClock clock(cycle);
  Sample now = with_ahead(0.0);
  now.controller_time = 30.0 * 86400.0;
  bool began_anew = false;
  for (double before = clock.time(); !began_anew; before = clock.time()) {
    clock.advance(now, cycle);
    ASSERT_EQ(static_cast<double>(static_cast<float>(clock.time())), clock.time());
    began_anew = clock.time() < before;
    ASSERT_TRUE(began_anew || clock.time() - before > 0.999);
    ASSERT_LE(clock.time(), SetpointClock::longest_time);
  }
  EXPECT_GT(clock.time(), 0.0) << "0: a setpoint without a time";
}

TEST(SetpointClockTest, AdvancesByTheElapsedTimeWhileTheTargetIsNotBehind)
{
  for (const double ahead : {4.0, 0.0, -1.0}) {
    EXPECT_EQ(pace(ahead), 1.0) << ahead;
    EXPECT_EQ(after_step(ahead).time(), 2.0) << ahead;
  }
  EXPECT_EQ(pace(std::numeric_limits<double>::quiet_NaN()), 1.0) << "not provided";
}

TEST(SetpointClockTest, LetsTheTargetCatchUpWithoutOvershoot)
{
  // The register is a few cycles old when the setpoint that answers it arrives.
  constexpr std::size_t delay = 4;
  std::vector<double> ahead(delay, -60.0);
  for (int i = 0; i < 300; ++i) {
    const double share = pace(ahead[ahead.size() - delay]);
    ASSERT_GE(share, 0.5);
    ahead.push_back(ahead.back() + 1.0 - share);
    ASSERT_LT(ahead.back(), 0.0) << "the target waits for setpoints";
  }
  EXPECT_GT(ahead.back(), -1.1);
}

TEST(SetpointClockTest, AdvancesByNoMoreThanTheControlProgramBridges)
{
  SetpointClock clock(cycle);
  EXPECT_DOUBLE_EQ(clock.advance(with_ahead(0.0), 30 * cycle), 30 * cycle);
  EXPECT_EQ(clock.time(), 1.0 + SetpointClock::bridged_cycles);
  clock.advance(with_ahead(0.0), -1.0);
  EXPECT_EQ(clock.time(), 1.0 + SetpointClock::bridged_cycles) << "another link";
}

TEST(SetpointClockTest, WaitsForTheTargetAtTheEndOfAPlanForALimitedTime)
{
  EXPECT_FALSE(after_step(0.0).is_at_end(-0.01));
  EXPECT_TRUE(after_step(0.0).is_at_end(0.0));
  EXPECT_FALSE(after_step(-2.0).is_at_end(0.5));
  EXPECT_TRUE(after_step(-2.0).is_at_end(1.1)) << "the register belongs to someone else";
}

}  // namespace
}  // namespace ur_ros_rtde
