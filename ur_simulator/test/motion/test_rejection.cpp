#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::six;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

void expect_rejected(const StartResult & start, const char * mentioned)
{
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().find(mentioned), std::string::npos) << start.error();
}

TEST(RejectionTest, ContainsFunctionArgumentAndValueIfNotFinite)
{
  ArmFixture fixture;
  Vector6 broken = default_position(fixture.model);
  broken[2] = nan_value;
  expect_rejected(fixture.arm.move_joint(broken, {1.4, 1.05}), "movej: target");
  expect_rejected(fixture.arm.move_linear(broken, {1.2, 0.25}), "movel: pose");
  expect_rejected(fixture.arm.servo_joint(broken, 0.002, 0.1, 300.0), "servoj: target");
  expect_rejected(fixture.arm.speed_joint(broken, 1.0, 0.0), "speedj: velocity");
  expect_rejected(fixture.arm.speed_linear(broken, 1.0, 0.0), "speedl: velocity");
  expect_rejected(fixture.arm.stop_joint(nan_value), "stopj: deceleration");
  expect_rejected(fixture.arm.stop_linear(std::numeric_limits<double>::infinity()), "stopl: deceleration");
  fixture.run(0.1);
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(RejectionTest, ContainsTheLimitsIfOutOfRange)
{
  ArmFixture fixture;
  const Vector6 home = default_position(fixture.model);
  expect_rejected(fixture.arm.move_joint(home, {0.0, 1.05}),
                  "movej: acceleration must be greater than 0, is 0");
  expect_rejected(fixture.arm.move_joint(home, {1.4, -1.0}), "movej: velocity must be greater than 0, is -1");
  expect_rejected(fixture.arm.move_joint(home, {1.4, 1.05, -2.0}), "movej: time");
  expect_rejected(fixture.arm.move_joint(home, {1.4, 1.05, 0.0, nan_value}), "movej: blend radius");
  expect_rejected(fixture.arm.servo_joint(home, 0.002, 0.01, 300.0),
                  "servoj: lookahead_time must be in [0.03, 0.2], is 0.01");
  expect_rejected(fixture.arm.servo_joint(home, 0.002, 0.1, 5000.0),
                  "servoj: gain must be in [100, 2000], is 5000");
  expect_rejected(fixture.arm.servo_joint(home, -0.002, 0.1, 300.0), "servoj: time");
  expect_rejected(fixture.arm.speed_joint(home, -1.0, 0.0), "speedj: acceleration");
  expect_rejected(fixture.arm.stop_joint(0.0), "stopj: deceleration");
}

TEST(RejectionTest, ContainsTheJointBeyondItsLimits)
{
  ArmFixture fixture;
  Vector6 beyond = default_position(fixture.model);
  beyond[3] = 6.5;
  expect_rejected(fixture.arm.move_joint(beyond, {1.4, 1.05}), "joint 3 of the target is 6.5000 rad");
  expect_rejected(fixture.arm.servo_joint(beyond, 0.002, 0.1, 300.0), "joint 3");
}

TEST(RejectionTest, OfAnUnreachableMoveLComesBeforeTheMotion)
{
  ArmFixture fixture;
  Vector6 far = fixture.tcp();
  far[0] = 5.0;
  expect_rejected(fixture.arm.move_linear(far, {1.2, 0.25}), "out of reach");
  fixture.run(0.1);
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(RejectionTest, DoesNotAffectTheActiveMotion)
{
  ArmFixture fixture;
  const Vector6 target = default_position(fixture.model) + six(0.3);
  const auto motion = fixture.arm.move_joint(target, {1.4, 1.05});
  fixture.run(0.2);
  EXPECT_FALSE(fixture.arm.move_joint(six(nan_value), {1.4, 1.05}));
  EXPECT_TRUE(fixture.arm.active(*motion));
  fixture.until_finished(*motion);
  EXPECT_EQ(fixture.state.target.position, target);
}

TEST(RejectionTest, ContainsTheModeWhileTheRobotIsNotRunning)
{
  ArmFixture fixture;
  fixture.state.robot_mode = RobotMode::idle;
  fixture.step();
  expect_rejected(fixture.arm.move_joint(default_position(fixture.model), {1.4, 1.05}), "IDLE");
  fixture.state.robot_mode = RobotMode::running;
  fixture.state.safety_mode = SafetyMode::protective_stop;
  fixture.step();
  expect_rejected(fixture.arm.speed_joint(six(0.1), 1.0, 0.0), "PROTECTIVE_STOP");
}

TEST(RejectionTest, WorksBeforeTheFirstCycle)
{
  const RobotModel & model = testing::model_named("ur5e");
  Arm arm(model, 0.002, default_position(model));
  expect_rejected(arm.move_joint(default_position(model), {1.4, 1.05}), "not started");
}

TEST(PowerLossTest, HoldsTheArmAndDiscardsTheMotion)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_joint(default_position(fixture.model) + six(1.0), {1.4, 1.05});
  fixture.run(0.5);
  fixture.state.robot_mode = RobotMode::power_off;
  fixture.step();
  const Vector6 position = fixture.state.actual.position;
  fixture.run(0.5);
  EXPECT_TRUE(fixture.arm.call_complete(*motion));
  EXPECT_EQ(fixture.state.actual.position, position);
  EXPECT_EQ(fixture.state.target.position, position);
  EXPECT_TRUE(fixture.state.actual.velocity.isZero(0.0));
  EXPECT_TRUE(fixture.state.actual.current.isZero(0.0));
  fixture.state.robot_mode = RobotMode::running;
  fixture.run(0.5);
  EXPECT_EQ(fixture.state.target.position, position);
}

TEST(SafetyStopTest, StopsTheArmWithoutACallOfStopAll)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  fixture.run(0.5);
  fixture.state.safety_mode = SafetyMode::protective_stop;
  fixture.until_rest(0.5);
}

TEST(TeleportTest, RejectsInvalidPositions)
{
  ArmFixture fixture;
  EXPECT_THROW(fixture.arm.teleport(six(nan_value), fixture.state), std::invalid_argument);
  EXPECT_THROW(fixture.arm.teleport(six(7.0), fixture.state), std::invalid_argument);
  EXPECT_THROW(Arm(fixture.model, 0.0, Vector6::Zero()), std::invalid_argument);
  EXPECT_THROW(Arm(fixture.model, 0.002, six(nan_value)), std::invalid_argument);
  EXPECT_EQ(fixture.state.actual.position, default_position(fixture.model));
}

}  // namespace
}  // namespace ur_simulator
