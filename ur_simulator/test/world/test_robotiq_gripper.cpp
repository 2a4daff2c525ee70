#include <gtest/gtest.h>

#include <functional>

#include "world/robotiq_gripper.hpp"

namespace ur_simulator {
namespace {

constexpr double cycle = 0.002;  // s

class RobotiqGripperTest : public ::testing::Test {
 protected:
  /// Steps until the condition is met; returns the simulated time, s, or -1 after 20 s.
  double run_until(const std::function<bool()> & condition)
  {
    for (int i = 0; i < 10000; ++i) {
      if (condition()) {
        return i * cycle;
      }
      gripper.step(cycle, true);
    }
    return -1.0;
  }
  int value(const char * name) const { return gripper.get(name).value(); }
  void activate()
  {
    gripper.set("ACT", 1);
    ASSERT_GE(run_until([&] { return value("STA") == 3; }), 0.0);
  }
  double move(int position, int speed = 255, int force = 0)
  {
    gripper.set("POS", position);
    gripper.set("SPE", speed);
    gripper.set("FOR", force);
    gripper.set("GTO", 1);
    gripper.step(cycle, true);
    return run_until([&] { return value("OBJ") != 0; });
  }
  RobotiqGripper gripper;
};

TEST_F(RobotiqGripperTest, ActivationClosesAndOpensTheFingers)
{
  gripper.set("ACT", 1);
  EXPECT_GE(run_until([&] { return value("POS") == RobotiqGripper::closed_position; }), 0.0);
  EXPECT_EQ(value("STA"), 1);
  EXPECT_GE(run_until([&] { return value("STA") == 3; }), 0.0);
  EXPECT_EQ(value("POS"), 0);
}

TEST_F(RobotiqGripperTest, MovesAtTheSpeedOfItsRegister)
{
  activate();
  EXPECT_NEAR(move(255, 255), RobotiqGripper::stroke / RobotiqGripper::max_speed, 0.01);
  EXPECT_EQ(value("OBJ"), 3);
  EXPECT_NEAR(move(0, 0), RobotiqGripper::stroke / RobotiqGripper::min_speed, 0.01);
}

// A recorded gripper closes at 227 and reports that it is at the requested position.
TEST_F(RobotiqGripperTest, ClosedFingersAreAtAnyLargerPosition)
{
  activate();
  move(255);
  EXPECT_EQ(value("POS"), 227);
  EXPECT_EQ(value("OBJ"), 3);
  EXPECT_EQ(value("PRE"), 255);
  EXPECT_EQ(gripper.width(), 0.0);
  gripper.set_object(5.0);
  move(0);
  move(255);
  EXPECT_EQ(value("OBJ"), 2);
  EXPECT_NEAR(gripper.width(), 5.0, 0.3);
}

TEST_F(RobotiqGripperTest, StopsAtAnObjectAndContinuesWhenItIsTaken)
{
  activate();
  gripper.set_object(42.5);
  move(255);
  EXPECT_EQ(value("OBJ"), 2);
  EXPECT_NEAR(gripper.width(), 42.5, 0.3);
  gripper.set_object(0.0);
  gripper.step(cycle, true);
  EXPECT_EQ(value("OBJ"), 0);
  run_until([&] { return value("OBJ") != 0; });
  EXPECT_EQ(value("OBJ"), 3);
}

TEST_F(RobotiqGripperTest, ForceCompressesASoftObject)
{
  activate();
  gripper.set_object(40.0, 20000.0);
  move(255, 255, 255);
  EXPECT_NEAR(gripper.width(), 40.0 - 1000.0 * RobotiqGripper::max_force / 20000.0, 0.3);
}

TEST_F(RobotiqGripperTest, StuckFingersAreAContact)
{
  activate();
  move(100);
  gripper.set_stuck(true);
  move(255);
  EXPECT_EQ(value("OBJ"), 2);
  move(0);
  EXPECT_EQ(value("OBJ"), 1);
}

TEST_F(RobotiqGripperTest, DoesNotMoveBeforeActivation)
{
  gripper.set("POS", 255);
  gripper.set("GTO", 1);
  gripper.step(cycle, true);
  EXPECT_EQ(value("FLT"), 7);
  EXPECT_EQ(value("POS"), 0);
  gripper.set("ACT", 1);
  gripper.step(cycle, true);
  EXPECT_EQ(value("FLT"), 5);
}

TEST_F(RobotiqGripperTest, MajorFaultStopsTheFingersUntilAReset)
{
  activate();
  gripper.set("POS", 255);
  gripper.set("GTO", 1);
  run_until([&] { return value("POS") > 100; });
  gripper.set_fault(14);
  const int before = value("POS");
  run_until([&] { return false; });
  EXPECT_EQ(value("POS"), before);
  EXPECT_EQ(value("FLT"), 14);
  gripper.set("ACT", 0);
  gripper.set("GTO", 0);
  gripper.step(cycle, true);
  EXPECT_EQ(value("FLT"), 0);
  EXPECT_EQ(value("STA"), 0);
}

TEST_F(RobotiqGripperTest, AutomaticReleaseNeedsAReset)
{
  activate();
  move(255);
  gripper.set("ATR", 1);
  gripper.step(cycle, true);
  EXPECT_EQ(value("FLT"), 11);
  EXPECT_GT(run_until([&] { return value("FLT") == 15; }), 3.0);
  EXPECT_EQ(value("POS"), 0);
  EXPECT_EQ(value("STA"), 0);
}

TEST_F(RobotiqGripperTest, ForgetsItsRegistersWithoutPower)
{
  activate();
  gripper.step(cycle, false);
  EXPECT_FALSE(gripper.is_powered());
  EXPECT_EQ(value("ACT"), 0);
  EXPECT_EQ(value("STA"), 0);
}

TEST_F(RobotiqGripperTest, RejectsUnknownRegistersAndValues)
{
  EXPECT_FALSE(gripper.set("XYZ", 1));
  EXPECT_FALSE(gripper.set("POS", 256));
  EXPECT_FALSE(gripper.set("STA", 3));
  EXPECT_FALSE(gripper.get("XYZ").has_value());
}

}  // namespace
}  // namespace ur_simulator
