#include <gtest/gtest.h>

#include "motion/profile.hpp"

namespace ur_simulator {
namespace {

TEST(TrapezoidProfile, takes_the_time_that_distance_speed_and_acceleration_say)
{
  const TrapezoidProfile profile(2.0, 0.5, 1.0);  // 0.5 s up, 3.5 s even, 0.5 s down
  EXPECT_NEAR(profile.duration(), 4.5, 1e-12);
  EXPECT_NEAR(profile.at(2.0).speed, 0.5, 1e-12);
  EXPECT_NEAR(profile.at(0.5).distance, 0.125, 1e-12);
  EXPECT_NEAR(profile.at(4.5).distance, 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(profile.at(100.0).distance, 2.0);
  EXPECT_DOUBLE_EQ(profile.at(100.0).speed, 0.0);
}

TEST(TrapezoidProfile, is_a_triangle_when_the_way_is_too_short_for_the_speed)
{
  const TrapezoidProfile profile(0.04, 10.0, 1.0);
  EXPECT_NEAR(profile.duration(), 0.4, 1e-12);
  EXPECT_NEAR(profile.at(0.2).speed, 0.2, 1e-12);
}

TEST(TrapezoidProfile, has_a_speed_that_is_the_slope_of_its_distance)
{
  const TrapezoidProfile profile(1.0, 0.4, 0.7);
  constexpr double step = 1e-6;
  for (double t = 0.01; t < profile.duration(); t += 0.01) {
    const double slope = (profile.at(t + step).distance - profile.at(t - step).distance) / (2.0 * step);
    EXPECT_NEAR(profile.at(t).speed, slope, 1e-6) << t;
  }
}

TEST(TrapezoidProfile, keeps_a_time_it_is_given)
{
  const auto gentle = TrapezoidProfile::in_time(1.0, 3.0, 1.2, 3.0, 40.0);
  EXPECT_NEAR(gentle.duration(), 3.0, 1e-9);
  EXPECT_NEAR(gentle.acceleration(), 1.2, 1e-12);
  const auto hurried = TrapezoidProfile::in_time(1.0, 0.5, 1.2, 10.0, 40.0);  // needs 16
  EXPECT_NEAR(hurried.duration(), 0.5, 1e-9);
  EXPECT_NEAR(hurried.acceleration(), 16.0, 1e-9);
}

TEST(TrapezoidProfile, takes_longer_than_asked_when_the_limits_do_not_allow_it)
{
  const auto profile = TrapezoidProfile::in_time(1.0, 0.1, 1.2, 2.0, 40.0);
  EXPECT_GT(profile.duration(), 0.1);
  EXPECT_LE(profile.at(0.5 * profile.duration()).speed, 2.0 + 1e-12);
  EXPECT_NEAR(profile.at(profile.duration()).distance, 1.0, 1e-12);
}

TEST(TrapezoidProfile, of_no_way_is_over_at_once)
{
  EXPECT_DOUBLE_EQ(TrapezoidProfile(0.0, 1.0, 1.0).duration(), 0.0);
  EXPECT_DOUBLE_EQ(TrapezoidProfile().duration(), 0.0);
}

TEST(PathClock, runs_out_when_told_to_brake_even_with_time_standing_still)
{
  PathClock clock;
  clock.advance(1.0, 1.0);
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
  clock.brake(0.5, 1.0);  // 0.5 s to stop
  for (int i = 0; i < 251; ++i) {
    clock.advance(0.002, 0.0);
  }
  EXPECT_TRUE(clock.stopped());
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
}

}  // namespace
}  // namespace ur_simulator
