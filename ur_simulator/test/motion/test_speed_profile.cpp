#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/path_clock.hpp"
#include "motion/speed_profile.hpp"

namespace ur_simulator {
namespace {

PathTiming timing(double length, double speed, double acceleration)
{
  PathTiming result;
  result.length = length;
  result.speed = speed;
  result.acceleration = result.end_acceleration = acceleration;
  return result;
}

/// The highest acceleration between two samples.
double hardest(const SpeedProfile & profile)
{
  constexpr double step = 1e-4;
  double result = 0.0;
  for (double t = 0.0; t < profile.duration(); t += step) {
    result = std::max(result, std::abs(profile.at(t + step).speed - profile.at(t).speed) / step);
  }
  return result;
}

TEST(ASpeedProfile, takes_the_time_that_distance_speed_and_acceleration_say)
{
  const SpeedProfile profile(timing(2.0, 0.5, 1.0));  // 0.5 s up, 3.5 s even, 0.5 s down
  EXPECT_NEAR(profile.duration(), 4.5, 1e-12);
  EXPECT_DOUBLE_EQ(profile.release_time(), profile.duration());
  EXPECT_NEAR(profile.at(2.0).speed, 0.5, 1e-12);
  EXPECT_NEAR(profile.at(0.5).distance, 0.125, 1e-12);
  EXPECT_NEAR(profile.at(4.5).distance, 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(profile.at(100.0).distance, 2.0);
  EXPECT_DOUBLE_EQ(profile.at(100.0).speed, 0.0);
}

TEST(ASpeedProfile, is_a_triangle_when_the_way_is_too_short_for_the_speed)
{
  const SpeedProfile profile(timing(0.04, 10.0, 1.0));
  EXPECT_NEAR(profile.duration(), 0.4, 1e-12);
  EXPECT_NEAR(profile.at(0.2).speed, 0.2, 1e-12);
}

TEST(ASpeedProfile, has_a_speed_that_is_the_slope_of_its_distance)
{
  PathTiming blended = timing(1.0, 0.4, 0.7);
  blended.ramp_time = 0.6;
  blended.ramp_room = 0.1;
  blended.end_room = 0.2;
  const SpeedProfile profile(blended);
  constexpr double step = 1e-6;
  for (double t = 0.01; t < profile.duration() - step; t += 0.01) {
    const double slope = (profile.at(t + step).distance - profile.at(t - step).distance) / (2.0 * step);
    EXPECT_NEAR(profile.at(t).speed, slope, 1e-6) << t;
  }
}

TEST(ASpeedProfile, keeps_a_time_it_is_given)
{
  const auto gentle = SpeedProfile::in_time(timing(1.0, 1.0, 1.2), 3.0, 3.0, 40.0);
  EXPECT_NEAR(gentle.duration(), 3.0, 1e-9);
  EXPECT_NEAR(gentle.acceleration(), 1.2, 1e-12);
  const auto hurried = SpeedProfile::in_time(timing(1.0, 1.0, 1.2), 0.5, 10.0, 40.0);  // needs 16
  EXPECT_NEAR(hurried.duration(), 0.5, 1e-9);
  EXPECT_NEAR(hurried.acceleration(), 16.0, 1e-9);
}

TEST(ASpeedProfile, takes_longer_than_asked_when_the_limits_do_not_allow_it)
{
  const auto profile = SpeedProfile::in_time(timing(1.0, 1.0, 1.2), 0.1, 2.0, 40.0);
  EXPECT_GT(profile.duration(), 0.1);
  EXPECT_LE(profile.at(0.5 * profile.duration()).speed, 2.0 + 1e-12);
  EXPECT_NEAR(profile.at(profile.duration()).distance, 1.0, 1e-12);
}

TEST(ASpeedProfile, of_no_way_is_over_at_once)
{
  EXPECT_DOUBLE_EQ(SpeedProfile(timing(0.0, 1.0, 1.0)).duration(), 0.0);
  EXPECT_DOUBLE_EQ(SpeedProfile().duration(), 0.0);
}

TEST(ASpeedProfile, decelerates_evenly_over_the_room_of_its_blend_and_no_harder_than_it_may)
{
  PathTiming blended = timing(1.0, 0.25, 1.2);
  blended.end_room = 0.05;
  const SpeedProfile profile(blended);
  const auto release = profile.at(profile.release_time());
  EXPECT_NEAR(release.distance, 0.95, 1e-9);
  EXPECT_NEAR(release.speed, 0.25, 1e-9);
  EXPECT_NEAR(profile.at(profile.duration() - 0.1).speed, 0.1 * 0.25 * 0.25 / 0.1, 1e-9);
  blended.end_room = 0.01;  // from 0.25 m/s it takes 26 mm at 1.2 m/s^2
  const SpeedProfile tight(blended);
  EXPECT_NEAR(tight.at(tight.release_time()).distance, 0.99, 1e-9);
  EXPECT_NEAR(tight.at(tight.release_time()).speed, std::sqrt(2.0 * 1.2 * 0.01), 1e-9);
  EXPECT_LT(hardest(tight), 1.2 + 1e-6);
}

TEST(ASpeedProfile, is_never_slower_for_its_blend_than_to_a_stop)
{
  for (const double room : {0.001, 0.02, 0.1, 0.3, 5.0}) {
    PathTiming blended = timing(0.3, 0.5, 1.2);
    const double to_a_stop = SpeedProfile(blended).duration();
    blended.end_room = room;
    EXPECT_LE(SpeedProfile(blended).release_time(), to_a_stop) << room;
  }
}

TEST(ASpeedProfile, grows_no_faster_than_the_motion_before_it_fades)
{
  PathTiming blended = timing(1.0, 0.25, 5.0);
  blended.ramp_time = 0.4;
  blended.ramp_room = 0.05;
  const SpeedProfile profile(blended);
  for (double t = 0.0; t < 0.4; t += 0.01) {
    EXPECT_LE(profile.at(t).speed, 0.25 * t / 0.4 + 1e-12);
  }
  EXPECT_LE(profile.at(0.4).distance, 0.05 + 1e-12);
}

TEST(ASpeedProfile, of_a_path_too_short_for_its_ramp_still_ends_at_its_end)
{
  for (const double length : {1e-6, 0.001, 0.02, 0.1}) {
    PathTiming blended = timing(length, 0.5, 1.0);
    blended.ramp_time = 0.4;
    blended.ramp_room = 0.1;
    const SpeedProfile profile(blended);
    EXPECT_NEAR(profile.at(profile.duration() - 1e-9).distance, length, 1e-8) << length;
    EXPECT_NEAR(profile.at(profile.duration() - 1e-9).speed, 0.0, 1e-4) << length;
    EXPECT_LT(hardest(profile), 1.0 + 1e-6) << length;
  }
}

TEST(ASpeedProfile, goes_on_at_the_speed_it_is_given_or_slows_down_to_its_own)
{
  PathTiming moving = timing(1.0, 0.25, 1.0);
  moving.start_speed = 0.25;
  const SpeedProfile even(moving);
  EXPECT_NEAR(even.duration(), (1.0 - 0.03125) / 0.25 + 0.25, 1e-9);
  moving.start_speed = 0.5;
  const SpeedProfile slowing(moving);
  EXPECT_NEAR(slowing.at(0.1).speed, 0.4, 1e-9);
  EXPECT_NEAR(slowing.at(0.5).speed, 0.25, 1e-9);
  EXPECT_LT(hardest(slowing), 1.0 + 1e-6);
}

TEST(ASpeedProfile, brakes_harder_where_its_acceleration_would_not_stop_it_in_time)
{
  PathTiming moving = timing(0.1, 1.0, 1.0);
  moving.start_speed = 1.0;  // needs 5
  const SpeedProfile profile(moving);
  EXPECT_NEAR(profile.at(profile.duration() - 1e-9).distance, 0.1, 1e-8);
  EXPECT_NEAR(hardest(profile), 5.0, 1e-3);
}

TEST(ASpeedProfile, may_be_taken_over_before_it_slows_down)
{
  PathTiming process = timing(1.0, 0.25, 1.2);
  process.end_room = 0.02;
  process.end_acceleration = 10.0;
  process.release_lead = 0.002;
  const SpeedProfile profile(process);
  EXPECT_NEAR(profile.at(profile.release_time()).distance, 0.98, 1e-9);
  EXPECT_NEAR(profile.at(profile.release_time() + 0.0019).speed, 0.25, 1e-9);
}

TEST(APathClock, runs_out_when_told_to_brake_even_with_time_standing_still)
{
  PathClock clock;
  clock.advance(1.0, 1.0);
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
  EXPECT_FALSE(clock.braking());
  clock.brake(0.5, 1.0);  // 0.5 s to stop
  EXPECT_TRUE(clock.braking());
  for (int i = 0; i < 251; ++i) {
    clock.advance(0.002, 0.0);
  }
  EXPECT_TRUE(clock.stopped());
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
}

}  // namespace
}  // namespace ur_simulator
