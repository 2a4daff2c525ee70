#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "checks.hpp"
#include "motion/motion.hpp"
#include "random_paths.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

Limits same_limits(double velocity, double acceleration, double jerk)
{
  Limits limits;
  limits.position_min.setConstant(-6.3);
  limits.position_max.setConstant(6.3);
  limits.velocity.setConstant(velocity);
  limits.acceleration.setConstant(acceleration);
  limits.jerk.setConstant(jerk);
  return limits;
}

Joints only(int joint, double value)
{
  Joints q = Joints::Zero();
  q[joint] = value;
  return q;
}

class RandomPathsTest : public testing::TestWithParam<bool> {};

TEST_P(RandomPathsTest, KeepsAllLimitsAndPassesAllWaypoints)
{
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomPath path = random_path(seed);
    const Limits limits = random_limits(seed, GetParam());
    const auto plan = plan_path(path.waypoints, limits, path.options);
    ASSERT_TRUE(plan) << "seed " << seed << ": " << plan.error().message;
    const Utilization use = finite_difference_utilization(*plan, limits);
    EXPECT_LE(use.velocity, 1.0) << "seed " << seed;
    EXPECT_LE(use.acceleration, 1.0) << "seed " << seed;
    EXPECT_LE(use.jerk, 1.0) << "seed " << seed;
    EXPECT_LE(max_waypoint_deviation(*plan, path.waypoints), path.options.blend_tolerance + 1e-8)
        << "seed " << seed;
    EXPECT_LT(speed_at_ends(*plan), 1e-6) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(JerkLimits, RandomPathsTest, testing::Bool(),
                         [](const auto & with) { return with.param ? "With" : "Without"; });

TEST(StraightLineTest, TakesTheTimeOfTheSevenPhaseProfile)
{
  // Seven phases with v = 1, a = 2, j = 10 and distance 2: acceleration takes v/a + a/j.
  const auto plan = plan_path(std::vector<Joints>{only(2, 0.0), only(2, 2.0)}, same_limits(1.0, 2.0, 10.0));
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->duration(), 2.0 / 1.0 + 1.0 / 2.0 + 2.0 / 10.0, 1e-3);
}

TEST(StraightLineTest, TakesTheClosedFormTimeWhenOnlyJerkLimits)
{
  const auto plan = plan_path(std::vector<Joints>{only(0, 0.0), only(0, 0.002)}, same_limits(1.0, 2.0, 10.0));
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->duration(), 4.0 * std::cbrt(0.002 / (2.0 * 10.0)), 1e-4);
}

TEST(StraightLineTest, TakesTheClosedFormTimeWithoutJerkLimits)
{
  const auto plan =
      plan_path(std::vector<Joints>{only(5, 1.0), only(5, -1.0)}, same_limits(10.0, 2.0, unlimited));
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->duration(), 2.0 * std::sqrt(2.0 / 2.0), 1e-3);
}

TEST(StraightLineTest, IsNotInterruptedByCollinearWaypoints)
{
  std::vector<Joints> waypoints;
  for (const double x : {0.0, 0.1, 0.1, 0.5, 0.500001, 2.0}) {
    waypoints.push_back(Joints::Constant(x));
  }
  const Limits limits = same_limits(1.0, 2.0, 10.0);
  const auto all = plan_path(waypoints, limits);
  const auto ends = plan_path(std::vector<Joints>{waypoints.front(), waypoints.back()}, limits);
  ASSERT_TRUE(all && ends);
  EXPECT_NEAR(all->duration(), ends->duration(), 1e-9);
}

TEST(CornerTest, IsPassedExactlyAndAtRestWithoutTolerance)
{
  const std::vector<Joints> waypoints{Joints::Zero(), only(0, 1.0), only(0, 1.0) + only(1, 1.0)};
  const auto plan = plan_path(waypoints, same_limits(1.0, 2.0, 20.0));
  ASSERT_TRUE(plan);
  const Point corner = plan->sample(plan->time_of_waypoint(1));
  EXPECT_LT((corner.position - waypoints[1]).abs().maxCoeff(), 1e-12);
  EXPECT_LT(corner.velocity.abs().maxCoeff(), 1e-6);
}

TEST(CornerTest, IsBlendedWithinToleranceInLessTime)
{
  const std::vector<Joints> waypoints{Joints::Zero(), only(0, 1.0), only(0, 1.0) + only(1, 1.0)};
  const Limits limits = same_limits(1.0, 2.0, 20.0);
  const auto exact = plan_path(waypoints, limits);
  const auto blended = plan_path(waypoints, limits, {.blend_tolerance = 0.05});
  ASSERT_TRUE(exact && blended);
  const Point corner = blended->sample(blended->time_of_waypoint(1));
  EXPECT_NEAR((corner.position - waypoints[1]).abs().maxCoeff(), 0.05, 1e-6);
  EXPECT_GT(corner.velocity.abs().maxCoeff(), 0.1);
  EXPECT_LT(blended->duration(), 0.9 * exact->duration());
}

TEST(SmoothCurveTest, IsPassedWithoutStopping)
{
  std::vector<Joints> waypoints;
  for (int i = 0; i <= 40; ++i) {
    waypoints.push_back(only(0, std::sin(0.05 * i)) + only(1, std::cos(0.05 * i)));
  }
  const auto plan = plan_path(waypoints, same_limits(1.0, 3.0, 30.0));
  ASSERT_TRUE(plan);
  for (std::size_t i = 1; i < 40; ++i) {
    EXPECT_GT(plan->sample(plan->time_of_waypoint(i)).velocity.matrix().norm(), 0.1) << "waypoint " << i;
  }
  EXPECT_LT(max_waypoint_deviation(*plan, waypoints), 1e-9);
}

TEST(SingleWaypointTest, YieldsTrajectoryOfZeroDuration)
{
  for (const std::size_t repetitions : {1U, 3U}) {
    const auto plan = plan_path(std::vector<Joints>(repetitions, only(3, 0.5)), same_limits(1.0, 2.0, 10.0));
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->duration(), 0.0);
    EXPECT_EQ(plan->sample(1.0).position[3], 0.5);
    EXPECT_EQ(plan->waypoint_count(), repetitions);
    EXPECT_EQ(plan->progress(0.0), 1.0);
  }
}

TEST(SpeedFractionTest, ScalesTheSameMotion)
{
  const RandomPath path = random_path(9);
  const Limits limits = random_limits(9, true);
  const auto full = plan_path(path.waypoints, limits);
  const auto half = plan_path(path.waypoints, limits, {.speed_fraction = 0.5});
  ASSERT_TRUE(full && half);
  EXPECT_NEAR(half->duration(), 2.0 * full->duration(), 1e-9);
  const Point fast = full->sample(0.4 * full->duration());
  const Point slow = half->sample(0.8 * full->duration());
  EXPECT_LT((fast.position - slow.position).abs().maxCoeff(), 1e-9);
  EXPECT_LT((fast.velocity - 2.0 * slow.velocity).abs().maxCoeff(), 1e-9);
  EXPECT_LT((fast.acceleration - 4.0 * slow.acceleration).abs().maxCoeff(), 1e-6);
}

TEST(ProgressTest, IncreasesMonotonicallyUpToTheLastWaypoint)
{
  const RandomPath path = random_path(7);
  const auto plan = plan_path(path.waypoints, random_limits(7, true), path.options);
  ASSERT_TRUE(plan);
  std::size_t waypoint = 0;
  double progress = 0.0;
  for (double time = -0.1; time < plan->duration() + 0.2; time += 0.01) {
    EXPECT_GE(plan->waypoint_at(time), waypoint);
    EXPECT_GE(plan->progress(time), progress);
    waypoint = plan->waypoint_at(time);
    progress = plan->progress(time);
  }
  EXPECT_EQ(waypoint, path.waypoints.size() - 1);
  EXPECT_EQ(progress, 1.0);
}

TEST(SampleTest, DerivativesMatchFiniteDifferences)
{
  const RandomPath path = random_path(5);
  const auto plan = plan_path(path.waypoints, random_limits(5, true), path.options);
  ASSERT_TRUE(plan);
  const double h = 1e-6;
  for (double time = 0.01; time < plan->duration() - 0.01; time += 0.0137) {
    const Point before = plan->sample(time - h);
    const Point after = plan->sample(time + h);
    const Point here = plan->sample(time);
    EXPECT_LT(((after.position - before.position) / (2 * h) - here.velocity).abs().maxCoeff(), 1e-6);
    EXPECT_LT(((after.velocity - before.velocity) / (2 * h) - here.acceleration).abs().maxCoeff(), 1e-3);
  }
}

// Low accelerations and a high jerk limit: long phases in which the jerk is constant.
Limits slow_limits()
{
  return same_limits(1.05, 1.4, 100.0);
}

std::vector<Joints> jumps(unsigned seed, std::size_t count)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> between(-2.0, 2.0);
  std::vector<Joints> points(count);
  for (Joints & point : points) {
    for (double & value : point) {
      value = between(random);
    }
  }
  return points;
}

TEST(AdaptiveGridTest, KeepsAllLimitsOfSlowRandomPaths)
{
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomPath path = random_path(seed);
    if (path.waypoints.size() > 40) {
      continue;
    }
    const auto plan = plan_path(path.waypoints, slow_limits(), path.options);
    ASSERT_TRUE(plan) << "seed " << seed << ": " << plan.error().message;
    const Utilization use = finite_difference_utilization(*plan, slow_limits());
    EXPECT_LE(use.velocity, 1.0) << "seed " << seed;
    EXPECT_LE(use.acceleration, 1.0) << "seed " << seed;
    EXPECT_LE(use.jerk, 1.0) << "seed " << seed;
    EXPECT_LE(max_waypoint_deviation(*plan, path.waypoints), path.options.blend_tolerance + 1e-8)
        << "seed " << seed;
  }
}

TEST(AdaptiveGridTest, KeepsAllLimitsBetweenDistantStations)
{
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto plan = plan_path(jumps(seed, 15), slow_limits(), {.blend_tolerance = 0.05});
    ASSERT_TRUE(plan) << plan.error().message;
    const auto use = plan->verify(slow_limits(), 1e-4);
    ASSERT_TRUE(use) << "seed " << seed << ": " << use.error().message;
    EXPECT_LE(std::max({use->velocity, use->acceleration, use->jerk}), 1.0) << "seed " << seed;
  }
}

TEST(AdaptiveGridTest, NeedsFewStationsForLongMotions)
{
  const std::size_t waypoints = 40;
  const auto plan = plan_path(jumps(7, waypoints), slow_limits(), {.blend_tolerance = 0.05});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_LT(plan->motion().timing.size(), 130 * waypoints);  // at equal distances: 700 for each waypoint
}

// The durations are those with stations at equal distances of time, 4.2 ms.
TEST(AdaptiveGridTest, TakesHardlyLongerThanWithStationsAtEqualDistances)
{
  const auto plan = plan_path(jumps(7, 120), slow_limits(), {.blend_tolerance = 0.05});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_LT(plan->duration(), 1.005 * 347.470);
}

TEST(ShortLineTest, DoesNotSlowDownTheMotionBetweenTwoBlends)
{
  // A line of 0.25 mrad between two blends. Nothing requires a low speed there; a plan that nearly stops
  // there takes 2.07 s.
  const RandomPath path = random_path(141);
  const auto plan = plan_path(path.waypoints, random_limits(141, true), path.options);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_LT(plan->duration(), 1.75);
}

TEST(LongMotionTest, IsRejectedWithItsDuration)
{
  Limits limits;
  limits.velocity.setConstant(1e-4);
  limits.acceleration.setConstant(1.0);
  limits.jerk.setConstant(10.0);
  const std::vector<Joints> there{Joints::Constant(-5.0), Joints::Constant(5.0)};
  const auto too_long = plan_path(there, limits);
  ASSERT_FALSE(too_long);
  EXPECT_NE(too_long.error().message.find("the motion would take 1000"), std::string::npos)
      << too_long.error().message;
  limits.velocity.setConstant(1e-3);
  EXPECT_TRUE(plan_path(there, limits));
  EXPECT_FALSE(plan_path(there, limits, {.speed_fraction = 0.1}));
}

TEST(ManyWaypointsTest, PlansTheMaximumNumberOfWaypoints)
{
  std::vector<Joints> waypoints;
  for (std::size_t i = 0; i < max_waypoints; ++i) {
    waypoints.push_back(Joints::Constant(0.0) + only(0, std::sin(0.001 * static_cast<double>(i))) +
                        only(1, std::cos(0.0013 * static_cast<double>(i))));
  }
  const Limits limits = same_limits(3.0, 5.0, 50.0);
  const auto plan = plan_path(waypoints, limits);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan->verify(limits));
  EXPECT_LT(max_waypoint_deviation(*plan, waypoints), 1e-8);
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
