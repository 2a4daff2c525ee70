#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/path/path_clock.hpp"
#include "motion/path/speed_profile.hpp"

namespace ur_simulator {
namespace {

ProfileConstraints timing(double length, double speed, double acceleration)
{
  ProfileConstraints result;
  result.length = length;
  result.speed = speed;
  result.acceleration = result.blend_out_acceleration = acceleration;
  return result;
}

/// The highest acceleration between two samples.
double max_acceleration(const SpeedProfile & profile)
{
  constexpr double step = 1e-4;
  double result = 0.0;
  for (double t = 0.0; t < profile.duration(); t += step) {
    result = std::max(result, std::abs(profile.sample(t + step).speed - profile.sample(t).speed) / step);
  }
  return result;
}

TEST(SpeedProfileTest, DurationFollowsFromDistanceSpeedAndAcceleration)
{
  const SpeedProfile profile(timing(2.0, 0.5, 1.0));  // accelerates 0.5 s, cruises 3.5 s, decelerates 0.5 s
  EXPECT_NEAR(profile.duration(), 4.5, 1e-12);
  EXPECT_DOUBLE_EQ(profile.blend_start_time(), profile.duration());
  EXPECT_NEAR(profile.sample(2.0).speed, 0.5, 1e-12);
  EXPECT_NEAR(profile.sample(0.5).distance, 0.125, 1e-12);
  EXPECT_NEAR(profile.sample(4.5).distance, 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(profile.sample(100.0).distance, 2.0);
  EXPECT_DOUBLE_EQ(profile.sample(100.0).speed, 0.0);
}

TEST(SpeedProfileTest, IsTriangularIfThePathIsTooShortForTheSpeed)
{
  const SpeedProfile profile(timing(0.04, 10.0, 1.0));
  EXPECT_NEAR(profile.duration(), 0.4, 1e-12);
  EXPECT_NEAR(profile.sample(0.2).speed, 0.2, 1e-12);
}

TEST(SpeedProfileTest, SpeedIsTheDerivativeOfTheDistance)
{
  ProfileConstraints blended = timing(1.0, 0.4, 0.7);
  blended.blend_in_time = 0.6;
  blended.blend_in_distance = 0.1;
  blended.blend_out_distance = 0.2;
  const SpeedProfile profile(blended);
  constexpr double step = 1e-6;
  for (double t = 0.01; t < profile.duration() - step; t += 0.01) {
    const double slope =
        (profile.sample(t + step).distance - profile.sample(t - step).distance) / (2.0 * step);
    EXPECT_NEAR(profile.sample(t).speed, slope, 1e-6) << t;
  }
}

TEST(SpeedProfileTest, KeepsTheGivenDuration)
{
  const auto gentle = SpeedProfile::with_duration(timing(1.0, 1.0, 1.2), 3.0, 3.0, 40.0);
  EXPECT_NEAR(gentle.duration(), 3.0, 1e-9);
  EXPECT_NEAR(gentle.acceleration(), 1.2, 1e-12);
  const auto hurried = SpeedProfile::with_duration(timing(1.0, 1.0, 1.2), 0.5, 10.0, 40.0);  // needs 16 m/s^2
  EXPECT_NEAR(hurried.duration(), 0.5, 1e-9);
  EXPECT_NEAR(hurried.acceleration(), 16.0, 1e-9);
}

TEST(SpeedProfileTest, TakesLongerIfTheLimitsDoNotAllowTheDuration)
{
  const auto profile = SpeedProfile::with_duration(timing(1.0, 1.0, 1.2), 0.1, 2.0, 40.0);
  EXPECT_GT(profile.duration(), 0.1);
  EXPECT_LE(profile.sample(0.5 * profile.duration()).speed, 2.0 + 1e-12);
  EXPECT_NEAR(profile.sample(profile.duration()).distance, 1.0, 1e-12);
}

TEST(SpeedProfileTest, HasZeroDurationForZeroLength)
{
  EXPECT_DOUBLE_EQ(SpeedProfile(timing(0.0, 1.0, 1.0)).duration(), 0.0);
  EXPECT_DOUBLE_EQ(SpeedProfile().duration(), 0.0);
}

TEST(SpeedProfileTest, DeceleratesConstantlyInTheBlendWithinTheLimit)
{
  ProfileConstraints blended = timing(1.0, 0.25, 1.2);
  blended.blend_out_distance = 0.05;
  const SpeedProfile profile(blended);
  const auto release = profile.sample(profile.blend_start_time());
  EXPECT_NEAR(release.distance, 0.95, 1e-9);
  EXPECT_NEAR(release.speed, 0.25, 1e-9);
  EXPECT_NEAR(profile.sample(profile.duration() - 0.1).speed, 0.1 * 0.25 * 0.25 / 0.1, 1e-9);
  blended.blend_out_distance = 0.01;  // stopping from 0.25 m/s takes 26 mm at 1.2 m/s^2
  const SpeedProfile tight(blended);
  EXPECT_NEAR(tight.sample(tight.blend_start_time()).distance, 0.99, 1e-9);
  EXPECT_NEAR(tight.sample(tight.blend_start_time()).speed, std::sqrt(2.0 * 1.2 * 0.01), 1e-9);
  EXPECT_LT(max_acceleration(tight), 1.2 + 1e-6);
}

TEST(SpeedProfileTest, BlendNeverTakesLongerThanAStop)
{
  for (const double room : {0.001, 0.02, 0.1, 0.3, 5.0}) {
    ProfileConstraints blended = timing(0.3, 0.5, 1.2);
    const double to_a_stop = SpeedProfile(blended).duration();
    blended.blend_out_distance = room;
    EXPECT_LE(SpeedProfile(blended).blend_start_time(), to_a_stop) << room;
  }
}

TEST(SpeedProfileTest, SpeedGrowsNoFasterThanThePreviousMotionDecays)
{
  ProfileConstraints blended = timing(1.0, 0.25, 5.0);
  blended.blend_in_time = 0.4;
  blended.blend_in_distance = 0.05;
  const SpeedProfile profile(blended);
  for (double t = 0.0; t < 0.4; t += 0.01) {
    EXPECT_LE(profile.sample(t).speed, 0.25 * t / 0.4 + 1e-12);
  }
  EXPECT_LE(profile.sample(0.4).distance, 0.05 + 1e-12);
}

TEST(SpeedProfileTest, EndsAtTheTargetIfThePathIsTooShortToBlendIn)
{
  for (const double length : {1e-6, 0.001, 0.02, 0.1}) {
    ProfileConstraints blended = timing(length, 0.5, 1.0);
    blended.blend_in_time = 0.4;
    blended.blend_in_distance = 0.1;
    const SpeedProfile profile(blended);
    EXPECT_NEAR(profile.sample(profile.duration() - 1e-9).distance, length, 1e-8) << length;
    EXPECT_NEAR(profile.sample(profile.duration() - 1e-9).speed, 0.0, 1e-4) << length;
    EXPECT_LT(max_acceleration(profile), 1.0 + 1e-6) << length;
  }
}

TEST(SpeedProfileTest, StartsAtTheGivenSpeedAndDeceleratesToItsOwn)
{
  ProfileConstraints moving = timing(1.0, 0.25, 1.0);
  moving.start_speed = 0.25;
  const SpeedProfile even(moving);
  EXPECT_NEAR(even.duration(), (1.0 - 0.03125) / 0.25 + 0.25, 1e-9);
  moving.start_speed = 0.5;
  const SpeedProfile slowing(moving);
  EXPECT_NEAR(slowing.sample(0.1).speed, 0.4, 1e-9);
  EXPECT_NEAR(slowing.sample(0.5).speed, 0.25, 1e-9);
  EXPECT_LT(max_acceleration(slowing), 1.0 + 1e-6);
}

TEST(SpeedProfileTest, ExceedsItsAccelerationIfItCouldNotStopInTime)
{
  ProfileConstraints moving = timing(0.1, 1.0, 1.0);
  moving.start_speed = 1.0;  // stopping needs 5 m/s^2
  const SpeedProfile profile(moving);
  EXPECT_NEAR(profile.sample(profile.duration() - 1e-9).distance, 0.1, 1e-8);
  EXPECT_NEAR(max_acceleration(profile), 5.0, 1e-3);
}

TEST(SpeedProfileTest, BlendMayStartBeforeTheDeceleration)
{
  ProfileConstraints process = timing(1.0, 0.25, 1.2);
  process.blend_out_distance = 0.02;
  process.blend_out_acceleration = 10.0;
  process.blend_start_lead = 0.002;
  const SpeedProfile profile(process);
  EXPECT_NEAR(profile.sample(profile.blend_start_time()).distance, 0.98, 1e-9);
  EXPECT_NEAR(profile.sample(profile.blend_start_time() + 0.0019).speed, 0.25, 1e-9);
}

TEST(PathClockTest, StopsAtSpeedScalingZero)
{
  PathClock clock;
  clock.advance(1.0, 1.0);
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
  EXPECT_FALSE(clock.decelerating());
  clock.decelerate(0.5, 1.0);  // stops in 0.5 s
  EXPECT_TRUE(clock.decelerating());
  for (int i = 0; i < 251; ++i) {
    clock.advance(0.002, 0.0);
  }
  EXPECT_TRUE(clock.stopped());
  EXPECT_DOUBLE_EQ(clock.time(), 1.0);
}

}  // namespace
}  // namespace ur_simulator
