#include <cmath>
#include <numbers>

#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::near_home;
using testing::six;

TEST(MoveJTest, EndsAtTheTargetAfterTheTimeOfTheLeadingJoint)
{
  ArmFixture fixture;
  const Vector6 target = near_home(fixture, six(0.5, -0.2, 0.3, 0.1, -1.0, 0.4));
  const auto motion = fixture.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(motion) << motion.error();
  const double time = fixture.until_finished(*motion);
  EXPECT_NEAR(time, 1.0 / 1.05 + 1.05 / 1.4, 2.0 * fixture.dt);  // s/v + v/a
  EXPECT_EQ(fixture.state.target.position, target);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
  fixture.until_rest(0.5);
  EXPECT_LT((fixture.state.actual.position - target).norm(), 1e-8);
}

TEST(MoveJTest, SynchronizesAllJointsWithTheLeadingJoint)
{
  ArmFixture fixture;
  const Vector6 away = six(0.5, -0.2, 0.3, 0.1, -1.0, 0.4);
  const Vector6 start = fixture.state.target.position;
  const auto motion = fixture.arm.move_joint(start + away, {1.4, 0.8});
  ASSERT_TRUE(motion);
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    const Vector6 done = (fixture.state.target.position - start).cwiseQuotient(away);
    EXPECT_LT(done.maxCoeff() - done.minCoeff(), 1e-9);
  }
  EXPECT_NEAR(fixture.max_velocity[4], 0.8, 1e-9);
  EXPECT_NEAR(fixture.max_velocity[0], 0.4, 1e-9);
  EXPECT_NEAR(fixture.max_acceleration, 1.4, 1e-6);
}

TEST(MoveJTest, TakesTheGivenTime)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(0.4)), {1.4, 1.05, 2.5});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 2.5, 2.0 * fixture.dt);
}

TEST(MoveJTest, KeepsTheJointSpeedLimits)
{
  for (const char * name : {"ur3e", "ur10e", "ur20", "ur5"}) {
    ArmFixture fixture(name);
    const auto motion =
        fixture.arm.move_joint(near_home(fixture, six(3.0, 0.5, 0.5, 0.5, 0.5, 0.5)), {40.0, 100.0});
    ASSERT_TRUE(motion);
    fixture.until_finished(*motion);
    EXPECT_NEAR(fixture.max_velocity[0], fixture.model.velocity_max[0], 1e-9) << name;
    EXPECT_LE(fixture.max_acceleration, 40.0 + 1e-6) << name;
  }
}

TEST(MoveJTest, ToThePresentPositionEndsAtOnce)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(fixture.state.target.position, {1.4, 1.05});
  ASSERT_TRUE(motion);
  EXPECT_LE(fixture.until_finished(*motion), 2.0 * fixture.dt);
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(StopJTest, DeceleratesTheFastestJointAsRequestedAndKeepsTheDirection)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(1.0, 0.5, -0.5, 0, 0, 0), 5.0, 0.0));
  fixture.run(0.5);
  const auto stop = fixture.arm.stop_joint(2.0);
  ASSERT_TRUE(stop);
  fixture.reset_maxima();
  EXPECT_NEAR(fixture.until_finished(*stop), 0.5, 2.0 * fixture.dt);
  EXPECT_NEAR(fixture.max_acceleration, 2.0, 1e-6);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
  fixture.until_rest(0.5);
}

TEST(SpeedJTest, CallReturnsAtTheVelocityAndTheMotionContinues)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.speed_joint(six(0.4, 0, 0, -0.8, 0, 0), 1.6, 0.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 0.5, 2.0 * fixture.dt);
  EXPECT_TRUE(fixture.arm.active(*motion));
  fixture.run(0.5);
  EXPECT_NEAR(fixture.state.target.velocity[3], -0.8, 1e-12);
  EXPECT_NEAR(fixture.max_acceleration, 1.6, 1e-6);
}

TEST(SpeedJTest, DeceleratesWhenTheTimeIsUpAndNothingFollows)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 1.6, 1.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 1.0, 1.5 * fixture.dt);
  EXPECT_NEAR(fixture.state.target.velocity[0], 0.4, 1e-12);
  fixture.until_rest(0.5);
  EXPECT_FALSE(fixture.arm.active(*motion));
}

TEST(SpeedJTest, RepeatedInTimeKeepsTheVelocity)
{
  ArmFixture fixture;
  for (int i = 0; i < 300; ++i) {
    const auto motion = fixture.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 4.0, 0.008);
    ASSERT_TRUE(motion);
    fixture.until_finished(*motion);
    if (i > 30) {
      ASSERT_NEAR(fixture.state.target.velocity[0], 0.4, 1e-9) << i;
    }
  }
}

TEST(SpeedJTest, StopsAtAJointLimitAndReportsTheJoint)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0, 0, 0, 0, 0, 2.0), 10.0, 0.0));
  std::optional<MotionFault> fault;
  fixture.until([&] { return (fault = fixture.arm.take_fault()).has_value(); }, 10.0);
  EXPECT_EQ(fault->kind, MotionFault::Kind::joint_position_limit);
  EXPECT_EQ(fault->joint, 5);
  EXPECT_NE(describe(*fault).find("wrist 3"), std::string::npos);
  fixture.until_rest(1.0);
  EXPECT_LE(fixture.state.target.position[5], fixture.model.position_max[5]);
  EXPECT_GT(fixture.state.target.position[5], fixture.model.position_max[5] - 0.01);
  EXPECT_LE(fixture.max_acceleration, 40.0 + 1e-6);
}

TEST(ServoJTest, TracksAMovingTargetWithTheLookaheadAsDelay)
{
  ArmFixture fixture;
  const Vector6 start = fixture.state.target.position;
  const double speed = 0.3, lookahead = 0.1;
  for (int i = 0; i < 1000; ++i) {
    const double t = (i + 1) * fixture.dt;
    ASSERT_TRUE(fixture.arm.servo_joint(start + six(speed * t), fixture.dt, lookahead, 300.0));
    fixture.step();
  }
  const double behind = (1000 * fixture.dt * speed) - (fixture.state.target.position[0] - start[0]);
  EXPECT_NEAR(behind / speed, lookahead, 2.0 * fixture.dt);
}

TEST(ServoJTest, ReachesAFarTargetWithinLimitsForAllParameters)
{
  for (const double gain : {100.0, 300.0, 2000.0}) {
    for (const double lookahead : {0.03, 0.1, 0.2}) {
      for (const char * name : {"ur10e", "ur5"}) {
        ArmFixture fixture(name);
        const Vector6 target = near_home(fixture, six(1.5, 0.3, -0.2, 0.1, 0.5, -1.0));
        ASSERT_TRUE(fixture.arm.servo_joint(target, fixture.dt, lookahead, gain));
        double beyond = 0.0;
        for (int i = 0; i < 20000 && !fixture.arm.at_rest(); ++i) {
          fixture.step();
          beyond = std::max(beyond, fixture.state.target.position[0] - target[0]);
        }
        EXPECT_TRUE(fixture.arm.at_rest()) << gain << " " << lookahead;
        EXPECT_LT(beyond, 0.03) << gain << " " << lookahead;
        EXPECT_LT((fixture.state.target.position - target).norm(), 1e-4);
        EXPECT_LE(fixture.max_acceleration, 40.0 + 1e-6);
        EXPECT_TRUE((fixture.max_velocity.array() <= fixture.model.velocity_max.array() + 1e-9).all());
      }
    }
  }
}

TEST(ServoJTest, AccelerationDoesNotJumpWhenTheTargetReverses)
{
  for (const double gain : {100.0, 300.0, 2000.0}) {
    ArmFixture fixture;
    const Vector6 start = fixture.state.target.position;
    const double angular_frequency = 2.0 * std::numbers::pi;  // rad/s: 0.3 rad at 1 Hz, at most 11.8 rad/s^2
    double previous_acceleration = 0.0;
    for (int i = 0; i < 1500; ++i) {
      const double t = (i + 1) * fixture.dt;
      const Vector6 target = start + six(0.3 * (1.0 - std::cos(angular_frequency * t)), 0, 0, 0, 0, 0);
      ASSERT_TRUE(fixture.arm.servo_joint(target, fixture.dt, 0.1, gain));
      fixture.step();
      const double acceleration =
          (fixture.state.target.velocity[0] - fixture.previous.velocity[0]) / fixture.dt;
      if (t > 1.0) {
        EXPECT_NEAR(acceleration, previous_acceleration, 0.5) << "gain " << gain << ", t = " << t;
      }
      previous_acceleration = acceleration;
    }
  }
}

TEST(ServoJTest, CallReturnsAfterItsTimeAndTheTargetIsHeld)
{
  ArmFixture fixture;
  const Vector6 target = near_home(fixture, six(0.05));
  const auto motion = fixture.arm.servo_joint(target, 0.1, 0.1, 300.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 0.1, 1.5 * fixture.dt);
  EXPECT_TRUE(fixture.arm.active(*motion));
  fixture.run(2.0);
  EXPECT_LT((fixture.state.target.position - target).norm(), 1e-5);
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(CancelTest, StopsAServoMotion)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.servo_joint(near_home(fixture, six(1.0)), fixture.dt, 0.05, 1000.0);
  ASSERT_TRUE(motion);
  fixture.run(0.3);
  ASSERT_GT(fixture.state.target.velocity.norm(), 0.5);
  fixture.reset_maxima();
  fixture.arm.cancel(*motion);
  EXPECT_TRUE(fixture.arm.call_complete(*motion));
  fixture.until_rest(2.0);
  EXPECT_LT(fixture.max_acceleration, 10.1);
}

TEST(CancelTest, OfAReplacedMotionDoesNotAffectTheNewOne)
{
  ArmFixture fixture;
  const auto first = fixture.arm.move_joint(near_home(fixture, six(0.5)), {1.4, 1.05});
  fixture.run(0.2);
  const Vector6 target = near_home(fixture, six(-0.3));
  const auto second = fixture.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(fixture.arm.call_complete(*first));
  EXPECT_FALSE(fixture.arm.active(*first));
  EXPECT_TRUE(fixture.arm.active(*second));
  fixture.arm.cancel(*first);
  fixture.until_finished(*second);
  EXPECT_EQ(fixture.state.target.position, target);
}

TEST(CancelTest, StopsWithTheSpeedSliderAtZero)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(0.5)), {1.4, 1.05});
  ASSERT_TRUE(motion);
  fixture.state.speed_slider = 0.0;
  fixture.run(1.0);
  fixture.arm.cancel(*motion);
  fixture.until_rest(2.0);
}

TEST(StopAllTest, StopsAtTheGivenDecelerationAndDiscardsTheMotion)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(near_home(fixture, six(2.0, 0, 0, 0, 0, 0)), {3.0, 1.5});
  ASSERT_TRUE(motion);
  fixture.run(0.8);
  fixture.reset_maxima();
  fixture.arm.stop_all(20.0);
  EXPECT_TRUE(fixture.arm.call_complete(*motion));
  EXPECT_FALSE(fixture.arm.active(*motion));
  const double time = fixture.until([&] { return fixture.state.target.velocity.isZero(0.0); }, 1.0);
  EXPECT_NEAR(time, 1.5 / 20.0, 2.0 * fixture.dt);
  EXPECT_NEAR(fixture.max_acceleration, 20.0, 1e-6);
  fixture.until_rest(0.5);
}

}  // namespace
}  // namespace ur_simulator
