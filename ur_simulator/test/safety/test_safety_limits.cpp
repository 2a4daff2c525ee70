#include <gtest/gtest.h>

#include "safety/limit_monitor.hpp"
#include "support/robot_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::RobotFixture;
using testing::six;

TEST(JointDeviationTest, TriggersProtectiveStopAtTheLimit)
{
  RobotFixture fixture;
  fixture.step();
  EXPECT_EQ(fixture.state.joint_deviation_ratio, 0.0);
  fixture.state.joint_deviation_ratio = 1.0;
  fixture.safety.step(fixture.state);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::protective_stop);
}

TEST(ForceLimitTest, TripsWhenTheToolIsDrivenIntoATable)
{
  RobotFixture fixture;
  fixture.world.surfaces().add(fixture.table_below(0.05, 20000.0));
  ASSERT_TRUE(fixture.move_down(0.3, 0.1));
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  fixture.until([&] { return fixture.arm.at_rest(); }, 1.0);
  EXPECT_NE(fixture.log().find("tool force"), std::string::npos);
  EXPECT_LT(fixture.state.contact_wrench[2], 600.0);
}

TEST(ForceLimitTest, ToleratesAShortPushAboveTheLimit)
{
  RobotFixture fixture;
  fixture.world.push({six(220.0, 0, 0, 0, 0, 0), 0.1, false});
  fixture.run(0.5);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
}

TEST(ForceLimitTest, TripsOnALongPushAboveTheLimit)
{
  RobotFixture fixture;
  fixture.world.push({six(220.0, 0, 0, 0, 0, 0), 2.0, false});
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 2.0);
}

TEST(ForceLimitTest, TripsAtOnceOnACollision)
{
  RobotFixture fixture;
  fixture.world.push({six(2000.0, 0, 0, 0, 0, 0), 0.02, false});
  fixture.run(0.02);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::protective_stop);
}

TEST(ForceLimitTest, AllowsAPressedToolToRetractAfterUnlockingButNotToPressHarder)
{
  RobotFixture fixture;
  fixture.world.surfaces().add(fixture.table_below(0.02, 20000.0));
  ASSERT_TRUE(fixture.move_down(0.3, 0.1));
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  fixture.run(5.1);
  ASSERT_GT(fixture.state.contact_wrench[2], 150.0);
  ASSERT_TRUE(fixture.safety.unlock_protective_stop());
  fixture.run(1.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << fixture.log();
  ASSERT_TRUE(fixture.move_down(-0.1, 0.1));
  fixture.run(2.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
  ASSERT_TRUE(fixture.move_down(0.3, 0.1));
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
}

TEST(SpeedLimitTest, OfTheToolTrips)
{
  RobotFixture fixture;
  SafetyLimits limits;
  limits.tool_speed = 0.25;
  fixture.safety.set_limits(limits);
  ASSERT_TRUE(fixture.move_down(0.2, 0.4));
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  EXPECT_NE(fixture.log().find("safety limit of 0.25 m/s"), std::string::npos);
}

TEST(JointLimitTest, OfPositionAndSpeedTrip)
{
  const RobotModel & model = testing::model_named("ur10e");
  LimitMonitor watch(model, 0.002);
  ControllerState state;
  EXPECT_FALSE(watch.check({}, state));
  state.actual.position[2] = model.position_max[2] + 0.1;
  ASSERT_TRUE(watch.check({}, state));
  EXPECT_NE(watch.check({}, state)->description.find("joint 2"), std::string::npos);
  state.actual.position[2] = 0.0;
  state.actual.velocity[1] = -1.2 * model.velocity_max[1];
  ASSERT_TRUE(watch.check({}, state));
  EXPECT_NE(watch.check({}, state)->description.find("joint 1"), std::string::npos);
}

TEST(JointLimitTest, AreNotExceededByAMoveJAtFullSpeed)
{
  for (const char * name : {"ur3e", "ur10e", "ur20", "ur5"}) {
    RobotFixture fixture(name);
    ASSERT_TRUE(fixture.arm.move_joint(default_position(fixture.model) + six(2.0, 0.3, 0.3, 1.0, 1.0, 2.0),
                                       {40.0, 10.0}));
    fixture.run(4.0);
    EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << name << fixture.log();
  }
}

TEST(LimitMonitorTest, DoesNotTripWhenDisabled)
{
  RobotFixture fixture;
  SafetyLimits limits;
  limits.monitor = false;
  fixture.safety.set_limits(limits);
  fixture.world.push({six(2000.0, 0, 0, 0, 0, 0), 0.5, false});
  fixture.run(1.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
}

TEST(MotionFaultTest, TriggersAProtectiveStopThatNamesTheCause)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0, 0, 0, 0, 0, 3.0), 20.0, 0.0));
  fixture.until([&] { return fixture.state.safety_mode == SafetyMode::protective_stop; }, 10.0);
  EXPECT_NE(fixture.log().find("joint wrist 3 reached its position limit"), std::string::npos);
  EXPECT_EQ(fixture.paused, 1);
}

}  // namespace
}  // namespace ur_simulator
