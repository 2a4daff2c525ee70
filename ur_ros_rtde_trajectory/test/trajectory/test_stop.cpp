#include <gtest/gtest.h>

#include <cmath>

#include "checks.hpp"
#include "random_paths.hpp"
#include "ur_ros_rtde_trajectory/plan.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

TEST(StopTest, KeepsLimitsFromAnyMoment)
{
  for (unsigned seed = 0; seed < 40; ++seed) {
    const RandomPath path = random_path(seed);
    const Limits limits = random_limits(seed, true);
    const auto plan = plan_path(path.waypoints, limits, path.options);
    ASSERT_TRUE(plan) << plan.error().message;
    for (const double part : {0.01, 0.3, 0.5, 0.77, 0.99}) {
      const double time = part * plan->duration();
      const Trajectory stop = *plan->stop_from(time, limits, no_deadline);
      EXPECT_GE(stop.duration(), time);
      EXPECT_LE(stop.duration(), plan->duration() + 1e-9);
      EXPECT_LT(stop.duration() - time, 2.0) << "seed " << seed << " part " << part;
      EXPECT_LT((stop.sample(0.99 * time).position - plan->sample(0.99 * time).position).abs().maxCoeff(),
                1e-12);
      EXPECT_LT(speed_at_ends(stop), 1e-5) << "seed " << seed << " part " << part;
      EXPECT_LE(stop.progress(stop.duration()), 1.0);
      const Utilization use = finite_difference_utilization(stop, limits);
      EXPECT_LE(use.velocity, 1.0) << "seed " << seed << " part " << part;
      EXPECT_LE(use.acceleration, 1.0) << "seed " << seed << " part " << part;
      EXPECT_LE(use.jerk, 1.0) << "seed " << seed << " part " << part;
    }
  }
}

TEST(StopTest, FromConstantSpeedIsNearlyTimeOptimal)
{
  Limits limits;
  limits.velocity.setConstant(1.0);
  limits.acceleration.setConstant(2.0);
  limits.jerk.setConstant(20.0);
  const auto plan = plan_path(std::vector<Joints>{Joints::Zero(), Joints::Constant(5.0)}, limits);
  ASSERT_TRUE(plan);
  const Trajectory stop = *plan->stop_from(2.0, limits, no_deadline);
  const double shortest = 1.0 / 2.0 + 2.0 / 20.0;
  EXPECT_LT(stop.duration() - 2.0, 1.15 * shortest);
}

struct Gentle {
  double velocity, acceleration, jerk;
};

class GentleStopTest : public testing::TestWithParam<Gentle> {
 protected:
  static Limits limits()
  {
    Limits result;
    result.velocity.setConstant(GetParam().velocity);
    result.acceleration.setConstant(GetParam().acceleration);
    result.jerk.setConstant(GetParam().jerk);
    return result;
  }
  /// s, from constant speed.
  static double shortest()
  {
    const auto & [v, a, j] = GetParam();
    return v * j > a * a ? v / a + a / j : 2.0 * std::sqrt(v / j);
  }
  static Trajectory plan()
  {
    Joints begin = Joints::Zero();
    begin[0] = -2.8;
    Joints end = Joints::Zero();
    end[0] = 2.8;
    return *plan_path(std::vector<Joints>{begin, end}, limits());
  }
};

TEST_P(GentleStopTest, IsNearlyTimeOptimalFromConstantSpeed)
{
  const Trajectory whole = plan();
  const double time = 0.5 * whole.duration();
  const auto stop = whole.stop_from(time, limits(), no_deadline);
  EXPECT_LT(stop->duration() - time, 1.15 * shortest());
  EXPECT_LT(speed_at_ends(*stop), 1e-5);
  EXPECT_TRUE(stop->verify(limits()));
}

TEST_P(GentleStopTest, EndsSoonFromEachMoment)
{
  const Trajectory whole = plan();
  for (const double part : {0.02, 0.1, 0.2, 0.3, 0.5, 0.6, 0.8, 0.95}) {
    const double time = part * whole.duration();
    const auto stop = whole.stop_from(time, limits(), no_deadline);
    // The acceleration of the plan may have to end first.
    EXPECT_LT(stop->duration() - time, 1.15 * shortest() + 2.0 * GetParam().acceleration / GetParam().jerk)
        << part;
    EXPECT_TRUE(stop->verify(limits()));
  }
}

INSTANTIATE_TEST_SUITE_P(Limits, GentleStopTest,
                         testing::Values(Gentle{1.05, 1.4, 100.0}, Gentle{1.0, 1.0, 0.5},
                                         Gentle{0.5, 0.2, 0.2}, Gentle{0.3, 0.05, 0.05},
                                         Gentle{0.5, 0.1, 0.1}, Gentle{0.5, 0.2, 0.05},
                                         Gentle{0.5, 0.1, 0.02}, Gentle{1.0, 5.0, 5.5e4},
                                         Gentle{1.0, 5.0, 1e7}),
                         [](const auto & test) { return "Row" + std::to_string(test.index); });

TEST(StopTest, IsNotSearchedBeyondTheDeadline)
{
  const Limits limits = random_limits(1, true);
  const auto plan = plan_path(random_path(1).waypoints, limits);
  ASSERT_TRUE(plan);
  EXPECT_FALSE(plan->stop_from(0.5 * plan->duration(), limits, std::chrono::steady_clock::now()));
}

TEST(StopTest, StaysOnThePath)
{
  Limits limits;
  limits.velocity.setConstant(1.0);
  limits.acceleration.setConstant(2.0);
  limits.jerk.setConstant(20.0);
  Joints corner = Joints::Zero();
  corner[0] = 1.0;
  Joints end = corner;
  end[1] = 1.0;
  const auto plan = plan_path(std::vector<Joints>{Joints::Zero(), corner, end}, limits);
  ASSERT_TRUE(plan);
  for (double from = 0.05; from < plan->duration(); from += 0.05) {
    const Trajectory stop = *plan->stop_from(from, limits, no_deadline);
    const Joints rest = stop.sample(stop.duration()).position;
    const bool on_first = std::abs(rest[1]) < 1e-9;
    const bool on_second = std::abs(rest[0] - 1.0) < 1e-9;
    EXPECT_TRUE(on_first || on_second) << "from " << from;
  }
}

TEST(StopTest, DoesNotMoveBeforeTheStart)
{
  Limits limits = random_limits(1, true);
  const auto plan = plan_path(random_path(1).waypoints, limits);
  ASSERT_TRUE(plan);
  for (const double time : {-1.0, 0.0}) {
    const Trajectory stop = *plan->stop_from(time, limits, no_deadline);
    EXPECT_LT(stop.duration(), 0.01);
    EXPECT_LT((stop.sample(1.0).position - plan->sample(0.0).position).abs().maxCoeff(), 1e-12);
  }
}

TEST(StopTest, IsThePlanItselfIfThatDoesNotMove)
{
  const auto plan = plan_path(std::vector<Joints>{Joints::Zero()}, random_limits(1, true));
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->stop_from(-1.0, random_limits(1, true), no_deadline)->duration(), 0.0);
}

TEST(StopTest, AfterTheEndReturnsTheTrajectory)
{
  Limits limits = random_limits(1, true);
  const auto plan = plan_path(random_path(1).waypoints, limits);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->stop_from(plan->duration() + 1.0, limits, no_deadline)->duration(), plan->duration());
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
