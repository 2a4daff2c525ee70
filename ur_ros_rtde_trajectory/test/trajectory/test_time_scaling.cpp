#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "random_paths.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"
#include "ur_ros_rtde_trajectory/time_scaling.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

constexpr double cycle = 0.002;
constexpr TimeScaling::Servo servo{.cycle = cycle, .lag = 0.1};

Limits test_limits()
{
  Limits result;
  result.velocity.setConstant(1.0);
  result.acceleration.setConstant(2.0);
  result.jerk.setConstant(20.0);
  return result;
}

Trajectory line()
{
  return *plan_path(std::vector<Joints>{Joints::Zero(), Joints::Constant(5.0)}, test_limits());
}

TEST(TimeScalingTest, FollowsTheControllerClock)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0);
  for (int k = 0; k < 1000; ++k) {
    scaling.advance(cycle, 1.0, plan.sample(scaling.time()), test_limits());
  }
  EXPECT_NEAR(scaling.time(), 2.0, 1e-9);
}

TEST(TimeScalingTest, KeepsFullRateWhenPackagesArriveInPairs)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0);
  for (int k = 0; k < 500; ++k) {
    scaling.advance(2.0 * cycle, 1.0, plan.sample(scaling.time()), test_limits());
  }
  EXPECT_NEAR(scaling.time(), 2.0, 1e-9);
}

TEST(TimeScalingTest, DoesNotJumpToATargetThatItMovesAwayFrom)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0, 1.0);
  while (scaling.rate() > 0.5) {
    scaling.advance(cycle, 0.0, plan.sample(scaling.time()), test_limits());
  }
  const double before = scaling.rate();
  scaling.advance(cycle, before + 0.003, plan.sample(scaling.time()), test_limits());
  EXPECT_LT(scaling.rate(), before);
}

TEST(TimeScalingTest, ContinuesSlowerWithoutSkippingAfterDelay)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0, 1.0);
  scaling.advance(0.054, 1.0, plan.sample(scaling.time()), test_limits());
  EXPECT_LE(scaling.time() - 1.0, 2.0 * cycle + 1e-12);
  EXPECT_NEAR(scaling.rate(), 0.5, 0.03);
  double before = scaling.rate();
  for (int k = 0; k < 500; ++k) {
    scaling.advance(cycle, 1.0, plan.sample(scaling.time()), test_limits());
    EXPECT_LE(std::abs(scaling.rate() - before), 2.001 * cycle);  // 2 rad/s^2 at 1 rad/s
    before = scaling.rate();
  }
  EXPECT_EQ(scaling.rate(), 1.0);
}

TEST(TimeScalingTest, KeepsFullRateInGapsThatTheControllerBridges)
{
  const Trajectory plan = line();
  TimeScaling scaling({.cycle = cycle, .lag = 0.1, .bridged_cycles = 5.0}, 1.0);
  for (int k = 0; k < 200; ++k) {
    scaling.advance(5.0 * cycle, 1.0, plan.sample(scaling.time()), test_limits());
  }
  EXPECT_NEAR(scaling.time(), 2.0, 1e-9);
  scaling.advance(0.06, 1.0, plan.sample(scaling.time()), test_limits());
  EXPECT_LE(scaling.time() - 2.0, 5.0 * cycle + 1e-12);
  EXPECT_LT(scaling.rate(), 0.6);
}

TEST(TimeScalingTest, ContinuesWhereTheSetpointStoodAfterDelay)
{
  constexpr double lead = 0.03;
  const Trajectory plan = line();
  TimeScaling scaling({.cycle = cycle, .lag = 0.1, .lead = lead}, 1.0, 2.0);
  scaling.advance(0.054, 1.0, plan.sample(scaling.time()), test_limits());
  EXPECT_LT(scaling.rate(), 0.55);
  const double setpoint = scaling.time() + lead * scaling.rate();
  EXPECT_GE(setpoint, 2.0 + lead);
  EXPECT_LE(setpoint, 2.0 + lead + 2.0 * cycle * 1.01);
}

// Simulates a loaded host: every 40 ms, no setpoint for 20 ms.
TEST(TimeScalingTest, MakesProgressDespiteRepeatedDelays)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0);
  double elapsed = 0.0;
  while (scaling.time() < plan.duration() && elapsed < 10.0 * plan.duration()) {
    for (int k = 0; k < 10; ++k, elapsed += cycle) {
      scaling.advance(cycle, 1.0, plan.sample(scaling.time()), test_limits());
    }
    scaling.advance(0.02, 1.0, plan.sample(scaling.time()), test_limits());
    elapsed += 0.02;
  }
  EXPECT_LT(elapsed, 8.0 * plan.duration());
}

TEST(TimeScalingTest, RestartsFromStandstillAfterLongDelay)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0, 1.0);
  scaling.advance(3.0, 1.0, plan.sample(scaling.time()), test_limits());
  EXPECT_LE(scaling.time() - 1.0, 2.0 * cycle);
  EXPECT_LT(scaling.rate(), 0.05);
}

TEST(TimeScalingTest, NeverRunsBackwardOrFasterThanThePlan)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> between(-0.02, 0.2);
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0);
  for (int k = 0; k < 20000; ++k) {
    const double before = scaling.time();
    const double elapsed = k % 3 == 0 ? between(random) : cycle;
    scaling.advance(elapsed, between(random) * 10.0, plan.sample(scaling.time()), test_limits());
    ASSERT_GE(scaling.time(), before);
    ASSERT_LE(scaling.time() - before, std::max(0.0, elapsed) + 1e-12);
    ASSERT_GE(scaling.rate(), 0.0);
    ASSERT_LE(scaling.rate(), 1.0);
  }
}

// Largest accelerations of the setpoints, by finite differences at the rate of the controller.
Joints largest_acceleration(const Trajectory & plan, const Limits & bounds, double later_target_rate)
{
  TimeScaling scaling(servo, 1.0);
  Joints q[3];
  q[0] = q[1] = plan.sample(0.0).position;
  Joints largest = Joints::Zero();
  for (int k = 0; k < 60000 && scaling.time() < plan.duration(); ++k) {
    const double target_rate = std::fmod(k * cycle, 2.0) < 1.0 ? 1.0 : later_target_rate;
    scaling.advance(cycle, target_rate, plan.sample(scaling.time()), bounds);
    q[2] = plan.sample(scaling.time()).position;
    largest = largest.max((q[2] - 2.0 * q[1] + q[0]).abs() / (cycle * cycle));
    q[0] = q[1];
    q[1] = q[2];
  }
  EXPECT_GE(scaling.time(), plan.duration());
  return largest;
}

TEST(TimeScalingTest, ChangesTheRateSmoothly)
{
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomPath path = random_path(seed);
    const Limits bounds = random_limits(seed, true);
    const auto plan = plan_path(path.waypoints, bounds, path.options);
    ASSERT_TRUE(plan) << plan.error().message;
    const Joints largest = largest_acceleration(*plan, bounds, 0.3);
    // Where the plan uses the limits completely, a change of the rate adds 2 /s times the velocity.
    const Joints allowed = bounds.acceleration * 1.05 + bounds.velocity * 2.2;
    EXPECT_TRUE((largest <= allowed).all()) << "seed " << seed << ": " << (largest / allowed).maxCoeff();
  }
}

// s, until `plan` is at rest if it brakes from `time` on, and the largest accelerations.
std::pair<double, Joints> brake(const Trajectory & plan, const Limits & bounds, double time)
{
  TimeScaling scaling(servo, 1.0, time);
  double elapsed = 0.0;
  Joints before = plan.sample(time).velocity;
  Joints largest = Joints::Zero();
  for (; scaling.rate() > 0.0 && scaling.time() < plan.duration(); elapsed += cycle) {
    scaling.advance(cycle, 0.0, plan.sample(scaling.time()), bounds);
    const Joints now = plan.sample(scaling.time()).velocity * scaling.rate();
    largest = largest.max((now - before).abs() / cycle);
    before = now;
  }
  return {elapsed, largest};
}

TEST(TimeScalingTest, BrakesAsGentlyAsTheLimits)
{
  Limits bounds = test_limits();
  for (const double gentleness : {1.0, 0.3, 0.1}) {
    bounds.acceleration.setConstant(2.0 * gentleness);
    bounds.jerk.setConstant(20.0 * gentleness);
    const auto plan = plan_path(std::vector<Joints>{Joints::Zero(), Joints::Constant(20.0)}, bounds);
    ASSERT_TRUE(plan);
    const auto [duration, largest] = brake(*plan, bounds, 0.5 * plan->duration());
    const double shortest = 1.0 / bounds.acceleration[0] + bounds.acceleration[0] / bounds.jerk[0];
    EXPECT_LT(duration, 1.1 * shortest);
    EXPECT_TRUE((largest <= 1.02 * bounds.acceleration).all()) << largest[0];
  }
}

TEST(TimeScalingTest, BrakesFromEachMomentWithinTwiceTheLimits)
{
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomPath path = random_path(seed);
    const Limits bounds = random_limits(seed, true);
    const auto plan = plan_path(path.waypoints, bounds, path.options);
    ASSERT_TRUE(plan) << plan.error().message;
    for (const double part : {0.05, 0.25, 0.5, 0.75, 0.95}) {
      const auto [duration, largest] = brake(*plan, bounds, part * plan->duration());
      EXPECT_LT(duration, 2.0) << "seed " << seed << " part " << part;
      EXPECT_TRUE((largest <= 2.1 * bounds.acceleration).all()) << "seed " << seed << " part " << part;
    }
  }
}

TEST(TimeScalingTest, StandsStillAtZeroRate)
{
  const Trajectory plan = line();
  TimeScaling scaling(servo, 1.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    scaling.advance(cycle, 0.0, plan.sample(scaling.time()), test_limits());
  }
  EXPECT_EQ(scaling.rate(), 0.0);
  const double time = scaling.time();
  scaling.advance(cycle, 0.0, plan.sample(time), test_limits());
  EXPECT_EQ(scaling.time(), time);
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
