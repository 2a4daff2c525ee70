#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "checks.hpp"
#include "ur_ros_rtde_trajectory/timed.hpp"

namespace ur_ros_rtde::trajectory::test {
namespace {

Limits limits()
{
  Limits result;
  result.position_min.setConstant(-6.3);
  result.position_max.setConstant(6.3);
  result.velocity.setConstant(3.0);
  result.acceleration.setConstant(8.0);
  result.jerk.setConstant(700.0);  // the accelerations of samples(2) begin and end with steps of up to 1.24
  return result;
}

// Unevenly spaced samples of a known motion from rest to rest: q = (1 - cos(pi t / 2)) / 2 * (j + 1) / 6, 0
// <= t <= 2.
TimedWaypoints samples(int order)
{
  TimedWaypoints waypoints;
  for (const double t : {0.0, 0.15, 0.3, 0.7, 0.9, 1.0, 1.4, 1.41, 1.8, 2.0}) {
    const double w = M_PI / 2.0;
    std::vector<double> q, v, a;
    for (int j = 0; j < joint_count; ++j) {
      const double size = 0.5 * (j + 1) / 6.0;
      q.push_back(size * (1.0 - std::cos(w * t)));
      v.push_back(size * w * std::sin(w * t));
      a.push_back(size * w * w * std::cos(w * t));
    }
    waypoints.times.push_back(t);
    waypoints.positions.push_back(q);
    if (order > 0) {
      waypoints.velocities.push_back(v);
    }
    if (order > 1) {
      waypoints.accelerations.push_back(a);
    }
  }
  return waypoints;
}

class TimedTrajectoryTest : public testing::TestWithParam<int> {};

TEST_P(TimedTrajectoryTest, PassesWaypointsOnTimeAndApproximatesTheSampledMotion)
{
  const TimedWaypoints waypoints = samples(GetParam());
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_DOUBLE_EQ(plan->duration(), 2.0);
  for (std::size_t i = 0; i < waypoints.times.size(); ++i) {
    const Point point = plan->sample(waypoints.times[i]);
    EXPECT_NEAR(point.position[5], waypoints.positions[i][5], 1e-9) << "waypoint " << i;
    EXPECT_NEAR(plan->time_of_waypoint(i), waypoints.times[i], 1e-9);
    if (GetParam() > 0 && i + 1 < waypoints.times.size()) {
      EXPECT_NEAR(point.velocity[5], waypoints.velocities[i][5], 1e-9) << "waypoint " << i;
    }
    if (GetParam() > 1 && i + 1 < waypoints.times.size()) {
      EXPECT_NEAR(point.acceleration[5], waypoints.accelerations[i][5], 1e-9) << "waypoint " << i;
    }
  }
  const double accuracy = GetParam() == 0 ? 0.02 : GetParam() == 1 ? 0.005 : 1e-4;
  for (double t = 0.0; t < 2.0; t += 0.01) {
    EXPECT_NEAR(plan->sample(t).position[5], 0.5 * (1.0 - std::cos(M_PI / 2.0 * t)), accuracy) << "at " << t;
  }
}

TEST(TimedTrajectoryLimitTest, IsFoundBetweenWaypointsThatAreClose)
{
  TimedWaypoints waypoints;
  const std::vector<double> zero(6, 0.0);
  const double distance = 1e-4, duration = 0.01;
  waypoints.times = {0.0, duration};
  waypoints.positions = {zero, {distance, 0.0, 0.0, 0.0, 0.0, 0.0}};
  waypoints.velocities = waypoints.accelerations = {zero, zero};
  Limits tight = limits();
  tight.jerk.setConstant(1e6);
  const double peak =
      10.0 / std::sqrt(3.0) * distance / (duration * duration);  // of a quintic from rest to rest
  tight.acceleration.setConstant(1.01 * peak);
  EXPECT_TRUE(plan_timed(waypoints, tight));
  tight.acceleration.setConstant(peak / 1.02);
  EXPECT_FALSE(plan_timed(waypoints, tight));
}

TEST_P(TimedTrajectoryTest, CanBeStoppedAlongItsPath)
{
  const auto plan = plan_timed(samples(GetParam()), limits());
  ASSERT_TRUE(plan) << plan.error().message;
  const Trajectory stop = *plan->stop_from(0.8, limits(), no_deadline);
  EXPECT_LT(stop.duration(), plan->duration());
  EXPECT_GT(stop.duration(), 0.8);
  EXPECT_TRUE(stop.verify(limits())) << stop.verify(limits()).error().message;
  EXPECT_LT(speed_at_ends(stop), 1e-5);
}

std::string name_of_order(const testing::TestParamInfo<int> & order)
{
  return order.param == 0 ? "Positions" : order.param == 1 ? "Velocities" : "Accelerations";
}

INSTANTIATE_TEST_SUITE_P(Given, TimedTrajectoryTest, testing::Values(0, 1, 2), name_of_order);

TEST(TimedPositionsTest, StartAndEndWithZeroAcceleration)
{
  const auto plan = plan_timed(samples(0), limits());
  ASSERT_TRUE(plan);
  EXPECT_LT(plan->sample(1e-9).acceleration.abs().maxCoeff(), 1e-5);
  EXPECT_LT(plan->sample(2.0 - 1e-9).acceleration.abs().maxCoeff(), 1e-5);
  const Utilization use = finite_difference_utilization(*plan, limits());
  EXPECT_LE(use.velocity, 1.0);
  EXPECT_LE(use.acceleration, 1.0);
  EXPECT_LE(use.jerk, 1.0);
}

struct Held {
  const char * name;
  std::vector<double> times, positions;
};

/// All joints at the same positions, which `velocities` reaches at rest, or does not mention.
TimedWaypoints waypoints_of(const Held & held, bool velocities)
{
  TimedWaypoints waypoints;
  waypoints.times = held.times;
  for (const double position : held.positions) {
    waypoints.positions.emplace_back(joint_count, position);
    if (velocities) {
      waypoints.velocities.emplace_back(joint_count, 0.0);
    }
  }
  return waypoints;
}

class HeldPositionTest : public testing::TestWithParam<std::tuple<Held, bool>> {};

TEST_P(HeldPositionTest, IsNotLeftAndNoTargetIsPassed)
{
  const auto & [held, velocities] = GetParam();
  const auto plan = plan_timed(waypoints_of(held, velocities), limits());
  ASSERT_TRUE(plan) << plan.error().message;
  for (std::size_t i = 0; i + 1 < held.times.size(); ++i) {
    const auto [low, high] = std::minmax(held.positions[i], held.positions[i + 1]);
    const double passed = velocities ? 1e-9 : 0.02 * (high - low) + 1e-9;
    for (double t = held.times[i]; t < held.times[i + 1]; t += 0.01) {
      const double position = plan->sample(t).position[3];
      EXPECT_GE(position, low - passed) << "at " << t;
      EXPECT_LE(position, high + passed) << "at " << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, HeldPositionTest,
    testing::Combine(testing::Values(Held{"ShortAfterLong", {0.0, 4.0, 5.0}, {0.0, 0.1, 0.6}},
                                     Held{"Dwell", {0.0, 2.0, 5.0, 7.0}, {0.0, 1.0, 1.0, 0.0}},
                                     Held{"DwellOnTheWay", {0.0, 1.0, 3.0, 4.0}, {0.0, 0.3, 0.3, 0.6}},
                                     Held{"Reversal", {0.0, 1.0, 2.0, 3.0}, {0.0, 0.5, -0.2, 0.1}},
                                     Held{"Uneven", {0.0, 0.7, 3.7, 4.4}, {0.0, 0.3, 0.35, 0.7}}),
                     testing::Bool()),
    [](const auto & given) {
      return std::string(std::get<0>(given.param).name) + (std::get<1>(given.param) ? "AtRest" : "");
    });

class SmoothReversalTest : public testing::TestWithParam<std::tuple<double, double>> {};

/// Samples of q = 0.3 sin^4(pi t / 3), which turns back at 1.5 s, between two of them.
TEST_P(SmoothReversalTest, IsAsSmoothAsWhatWasSampled)
{
  const auto & [step, phase] = GetParam();
  const double end = 3.0;
  TimedWaypoints waypoints;
  const auto add = [&](double t) {
    waypoints.times.push_back(t);
    waypoints.positions.emplace_back(joint_count, 0.3 * std::pow(std::sin(M_PI * t / end), 4));
  };
  add(0.0);
  for (double t = (1.0 - phase) * step; t < end - 0.4 * step; t += step) {
    add(t);
  }
  add(end);
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_TRUE(plan) << plan.error().message;
  double acceleration = 0.0, jerk = 0.0;
  for (double t = 0.5; t < end - 0.5; t += 0.0005) {
    acceleration = std::max(acceleration, plan->sample(t).acceleration.abs().maxCoeff());
    jerk = std::max(jerk, plan->sample(t).jerk.abs().maxCoeff());
  }
  EXPECT_LT(acceleration, 1.05 * 1.316);  // of the sampled motion
  EXPECT_LT(jerk, 1.05 * 3.77);
}

INSTANTIATE_TEST_SUITE_P(Sampled, SmoothReversalTest,
                         testing::Combine(testing::Values(0.008, 0.02, 0.05, 0.1),
                                          testing::Values(0.0, 0.3, 0.5)));

/// As MoveIt's time parameterization: samples at a fixed rate, and the end.
TEST(CloseWaypointsTest, AreDroppedIfTheArmHardlyMovesBetweenThem)
{
  TimedWaypoints waypoints = samples(2);
  waypoints.times[7] = waypoints.times[6] + 5e-5;
  waypoints.positions[7] = waypoints.positions[6];
  waypoints.times[8] = 2.0 - 5e-5;
  waypoints.positions[8] = waypoints.positions[9];
  TimedWaypoints dropped = waypoints;
  drop_close_waypoints(dropped);
  ASSERT_EQ(dropped.times.size(), waypoints.times.size() - 2);
  EXPECT_EQ(dropped.times[6], waypoints.times[6]);
  EXPECT_EQ(dropped.times[7], 2.0);
  EXPECT_EQ(dropped.velocities[7], waypoints.velocities[9]);
  EXPECT_EQ(dropped.accelerations.size(), dropped.times.size());
  waypoints.positions[7][0] += 0.01;  // in 50 us
  waypoints.times[9] = waypoints.times[8];
  TimedWaypoints kept = waypoints;
  drop_close_waypoints(kept);
  EXPECT_EQ(kept.times, waypoints.times);
  EXPECT_FALSE(plan_timed(kept, limits()));
}

TEST(CloseWaypointsTest, StayIfTheListsDoNotFit)
{
  TimedWaypoints waypoints;
  waypoints.times = {0.0, 5e-5, 1e-4, 1.0};
  for (int i = 0; i < 3; ++i) {
    drop_close_waypoints(waypoints);
    EXPECT_EQ(waypoints.times.size(), 4U);
    EXPECT_FALSE(plan_timed(waypoints, limits()));
    waypoints.positions.emplace_back(joint_count, 0.0);
  }
}

TEST(PlanTimedTest, RejectsFirstExceededLimit)
{
  TimedWaypoints waypoints = samples(2);
  for (double & time : waypoints.times) {
    time *= 0.2;
  }
  Limits without_jerk = limits();
  without_jerk.jerk.setConstant(unlimited);
  const auto plan = plan_timed(waypoints, without_jerk);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
  for (const char * part : {"acceleration of ", "rad/s^2 at ", "its limit 8", "waypoint 0"}) {
    EXPECT_NE(plan.error().message.find(part), std::string::npos) << plan.error().message;
  }
}

struct InvalidWaypoints {
  const char * name;
  void (*modify)(TimedWaypoints &);
  const char * message_part;
};

class InvalidTimedWaypointsTest : public testing::TestWithParam<InvalidWaypoints> {};

TEST_P(InvalidTimedWaypointsTest, AreRejectedWithTheReason)
{
  TimedWaypoints waypoints = samples(2);
  GetParam().modify(waypoints);
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
  EXPECT_NE(plan.error().message.find(GetParam().message_part), std::string::npos) << plan.error().message;
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Each, InvalidTimedWaypointsTest,
    testing::Values(
        InvalidWaypoints{"NoWaypoint", [](TimedWaypoints & w) { w = {}; }, "times is empty"},
        InvalidWaypoints{"FirstTimeNotZero", [](TimedWaypoints & w) { w.times[0] = 0.05; },
                         "times[0] is 0.05"},
        InvalidWaypoints{"TimesEqual", [](TimedWaypoints & w) { w.times[4] = w.times[3]; },
                         "times[4] is 0.7"},
        InvalidWaypoints{"TimesDecreasing", [](TimedWaypoints & w) { w.times[4] = 0.1; }, "times[4] is 0.1"},
        InvalidWaypoints{"TimeNan", [](TimedWaypoints & w) { w.times[4] = nan_value; }, "times[4] is nan"},
        InvalidWaypoints{"TimeInfinite", [](TimedWaypoints & w) { w.times.back() = INFINITY; },
                         "times[9] is inf"},
        InvalidWaypoints{"TooLong", [](TimedWaypoints & w) { w.times.back() = 5e6; },
                         "times[9] is 5e+06 s: times begin at 0 and end at 86400 s at the latest"},
        InvalidWaypoints{"AccelerationAtTheStart",
                         [](TimedWaypoints & w) { w.accelerations.front()[2] = -4.0; },
                         "the first of elbow_joint is -4 rad/s^2, a step from rest that needs a jerk of 2000 "
                         "rad/s^3, its limit is 700 rad/s^3"},
        InvalidWaypoints{"PositionMissing", [](TimedWaypoints & w) { w.positions.pop_back(); },
                         "positions has 9 entries"},
        InvalidWaypoints{"VelocityMissing", [](TimedWaypoints & w) { w.velocities.pop_back(); },
                         "velocities has 9 entries"},
        InvalidWaypoints{"AccelerationMissing", [](TimedWaypoints & w) { w.accelerations.pop_back(); },
                         "accelerations has 9 entries"},
        InvalidWaypoints{"FiveJoints", [](TimedWaypoints & w) { w.positions[2].pop_back(); },
                         "positions[2] has 5 values"},
        InvalidWaypoints{"SevenVelocities", [](TimedWaypoints & w) { w.velocities[2].push_back(0); },
                         "velocities[2] has 7 values"},
        InvalidWaypoints{"PositionNan", [](TimedWaypoints & w) { w.positions[3][1] = nan_value; },
                         "positions[3] of shoulder_lift_joint is nan"},
        InvalidWaypoints{"VelocityAtTheEnd", [](TimedWaypoints & w) { w.velocities.back()[0] = 0.5; },
                         "the last of shoulder_pan_joint is 0.5"},
        InvalidWaypoints{"AccelerationsAlone", [](TimedWaypoints & w) { w.velocities.clear(); },
                         "accelerations are given without velocities"},
        InvalidWaypoints{"BeyondPositionLimit", [](TimedWaypoints & w) { w.positions.back()[0] = 7.0; },
                         "of shoulder_pan_joint is"}),
    [](const auto & bad) { return bad.param.name; });

TEST(PlanTimedTest, PlansTheLongestListButNoLongerOne)
{
  TimedWaypoints waypoints;
  for (std::size_t i = 0; i <= max_timed_waypoints; ++i) {
    waypoints.times.push_back(0.008 * static_cast<double>(i));
    const double turns = 2.0 * static_cast<double>(i) / static_cast<double>(max_timed_waypoints - 1);
    waypoints.positions.emplace_back(6, 1.0 - std::cos(2.0 * M_PI * turns));
  }
  EXPECT_NE(plan_timed(waypoints, limits()).error().message.find("at most 100000"), std::string::npos);
  waypoints.times.pop_back();
  waypoints.positions.pop_back();
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_NEAR(plan->duration(), 800.0, 0.01);
}

TEST(PlanTimedTest, FindsViolationsInThePieceOfHours)
{
  TimedWaypoints waypoints;
  waypoints.times = {0.0, 1.0, 9000.0};
  waypoints.positions = {std::vector<double>(6, 0.0), std::vector<double>(6, 0.5),
                         std::vector<double>(6, 0.0)};
  waypoints.velocities = {std::vector<double>(6, 0.0), std::vector<double>(6, 1.0),
                          std::vector<double>(6, 0.0)};
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("position of shoulder_pan_joint"), std::string::npos)
      << plan.error().message;
}

TEST(PlanTimedTest, RejectsWhatIsNoNumberAnyMore)
{
  TimedWaypoints waypoints = samples(1);
  waypoints.velocities[3][1] = 1e308;
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, ErrorCode::invalid_goal);
}

TEST(PlanTimedTest, SingleWaypointYieldsZeroDuration)
{
  TimedWaypoints waypoints;
  waypoints.times = {0.0};
  waypoints.positions = {std::vector<double>(6, 0.25)};
  const auto plan = plan_timed(waypoints, limits());
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->duration(), 0.0);
  EXPECT_EQ(plan->sample(0.0).position[0], 0.25);
}

}  // namespace
}  // namespace ur_ros_rtde::trajectory::test
