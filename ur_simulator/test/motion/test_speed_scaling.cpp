#include <cmath>

#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::near_home;
using testing::six;

TEST(MoveJTest, TakesTwiceTheTimeWithTheSpeedSliderAtOneHalf)
{
  ArmFixture fixture;
  fixture.state.speed_slider = 0.5;
  fixture.run(1.0);  // the scaling has ramped down
  EXPECT_NEAR(fixture.state.speed_scaling, 0.5, 1e-9);
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(1.0, 0, 0, 0, 0, 0)), {1.4, 1.05});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 2.0 * (1.0 / 1.05 + 1.05 / 1.4), 2.0 * fixture.dt);
  EXPECT_NEAR(fixture.max_velocity[0], 0.525, 1e-6);
}

TEST(ProgramStartTest, TimeOfTheFirstPathStartsSlowly)
{
  ArmFixture fixture;
  fixture.arm.begin_program();
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(1.0, 0, 0, 0, 0, 0)), {0.8, 0.6});
  ASSERT_TRUE(motion);
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.8 * std::pow(0.1, 3) / (2.0 * 0.16 * 0.16), 1e-3);
  EXPECT_NEAR(0.1 + fixture.until_finished(*motion), 0.08 + 1.0 / 0.6 + 0.6 / 0.8, 2.0 * fixture.dt);
}

TEST(ProgramStartTest, ALaterPathStartsAtFullScaling)
{
  ArmFixture fixture;
  fixture.arm.begin_program();
  fixture.run(0.2);
  ASSERT_TRUE(fixture.arm.move_joint(near_home(fixture, six(1.0, 0, 0, 0, 0, 0)), {0.8, 0.6}));
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.08, 2e-3);
}

TEST(ProgramStartTest, APathThatReplacesAStopKeepsItsVelocity)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.move_joint(near_home(fixture, six(1.0, 0, 0, 0, 0, 0)), {1.4, 1.0}));
  fixture.run(0.5);
  fixture.arm.stop_all(2.0);
  fixture.run(0.1);
  fixture.reset_maxima();
  fixture.arm.begin_program();
  ASSERT_TRUE(fixture.arm.move_joint(near_home(fixture, six(0.0, 0.5, 0, 0, 0, 0)), {1.4, 1.0}));
  fixture.run(0.5);
  EXPECT_LT(fixture.max_acceleration, 10.0) << "no jump of the velocity";
}

TEST(SpeedSliderTest, ScalesSpeedjInVelocityAndTime)
{
  ArmFixture fixture;
  fixture.state.speed_slider = 0.25;
  fixture.run(1.0);
  const auto motion = fixture.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 1.6, 1.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 4.0, 2.0 * fixture.dt);
  EXPECT_NEAR(fixture.max_velocity[0], 0.1, 1e-9);
  EXPECT_NEAR(fixture.state.target.position[0], 0.25 * (4.0 - 0.5) * 0.4, 1e-3) << "as far as at 100 %";
}

TEST(SpeedSliderTest, StopsSpeedjAtZeroAndLetsItGoOn)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 1.6, 0.0));
  fixture.run(1.0);
  fixture.state.speed_slider = 0.0;
  fixture.run(1.0);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(1e-9));
  fixture.state.speed_slider = 1.0;
  fixture.run(2.0);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.4, 1e-9);
}

TEST(SpeedSliderTest, DoesNotWeakenAStop)
{
  ArmFixture fixture;
  fixture.state.speed_slider = 0.5;
  fixture.run(1.0);
  ASSERT_TRUE(fixture.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 4.0, 0.0));
  fixture.run(2.0);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.5, 1e-9);
  ASSERT_TRUE(fixture.arm.stop_joint(2.0));
  EXPECT_NEAR(fixture.until_rest(5.0), 0.25, 0.1);
}

TEST(SpeedSliderTest, ChangeDuringAMotionIsGradual)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(2.0, 0, 0, 0, 0, 0)), {2.0, 1.0});
  ASSERT_TRUE(motion);
  fixture.run(1.0);
  fixture.reset_maxima();
  fixture.state.speed_slider = 0.0;
  fixture.run(1.0);
  EXPECT_LT(fixture.max_acceleration, 2.5);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.0, 1e-9);
  EXPECT_FALSE(fixture.arm.call_complete(*motion));
  const double stood_at = fixture.state.target.position[0];
  fixture.run(1.0);
  EXPECT_DOUBLE_EQ(fixture.state.target.position[0], stood_at);
  fixture.state.speed_slider = 1.0;
  fixture.until_finished(*motion);
  EXPECT_LT(fixture.max_acceleration, 2.5);
  EXPECT_NEAR(fixture.state.target.position[0], 2.0, 1e-12);
}

TEST(PauseTest, TheEndOfAProgramDuringItDoesNotMakeTheArmFaster)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.move_joint(near_home(fixture, six(2.0, 0, 0, 0, 0, 0)), {2.0, 1.0}));
  fixture.run(1.0);
  fixture.arm.pause();
  fixture.run(0.4);
  fixture.arm.cancel_all();
  fixture.arm.resume();
  double velocity = fixture.state.target.velocity[0];
  EXPECT_GT(velocity, 0.1);
  while (velocity > 0.0) {
    fixture.run(fixture.dt);
    ASSERT_LT(fixture.state.target.velocity[0], velocity);
    velocity = fixture.state.target.velocity[0];
  }
  fixture.run(1.0);
  EXPECT_NEAR(fixture.state.speed_scaling, 1.0, 1e-9) << "for the next program";
}

TEST(PauseTest, LeavesTheSpeedSlider)
{
  ArmFixture fixture;
  fixture.arm.pause();
  fixture.run(1.0);
  EXPECT_EQ(fixture.state.speed_scaling, 0.0);
  EXPECT_EQ(fixture.state.target_speed_fraction, 1.0);
}

TEST(PauseTest, StopsTheMotionUntilResume)
{
  ArmFixture fixture;
  const Vector6 target = near_home(fixture, six(1.0, 0, 0, 0, 0, 0));
  const auto motion = fixture.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(motion);
  fixture.run(0.5);
  fixture.arm.pause();
  fixture.run(2.0);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(1e-9));
  EXPECT_FALSE(fixture.arm.call_complete(*motion));
  fixture.arm.resume();
  fixture.until_finished(*motion);
  EXPECT_EQ(fixture.state.target.position, target);
}

}  // namespace
}  // namespace ur_simulator
