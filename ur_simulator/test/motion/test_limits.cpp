#include <gtest/gtest.h>

#include "safety/watch.hpp"
#include "whole_rig.hpp"

namespace ur_simulator {
namespace {

using testing::six;
using testing::WholeRig;

TEST(ForceLimit, trips_when_the_tool_is_driven_into_a_table_and_nothing_stops_it)
{
  WholeRig rig;
  rig.world.place_surface(rig.table_below(0.05, 20000.0));
  ASSERT_TRUE(rig.move_down(0.3, 0.1));
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  rig.until([&] { return rig.arm.at_rest(); }, 1.0);
  EXPECT_NE(rig.log().find("tool force"), std::string::npos);
  EXPECT_LT(rig.state.contact_wrench[2], 600.0);
}

TEST(ForceLimit, bears_a_short_push_above_it)
{
  WholeRig rig;
  rig.world.push({six(220.0, 0, 0, 0, 0, 0), 0.1, false});
  rig.run(0.5);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
}

TEST(ForceLimit, trips_on_a_long_push_above_it)
{
  WholeRig rig;
  rig.world.push({six(220.0, 0, 0, 0, 0, 0), 2.0, false});
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 2.0);
}

TEST(ForceLimit, trips_at_once_on_a_collision)
{
  WholeRig rig;
  rig.world.push({six(2000.0, 0, 0, 0, 0, 0), 0.02, false});
  rig.run(0.02);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::protective_stop);
}

TEST(ForceLimit, lets_a_pressed_tool_leave_after_it_was_unlocked_but_not_press_on)
{
  WholeRig rig;
  rig.world.place_surface(rig.table_below(0.02, 20000.0));
  ASSERT_TRUE(rig.move_down(0.3, 0.1));
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  rig.run(5.1);
  ASSERT_GT(rig.state.contact_wrench[2], 150.0);
  ASSERT_TRUE(rig.safety.unlock_protective_stop());
  rig.run(1.0);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << rig.log();
  ASSERT_TRUE(rig.move_down(-0.1, 0.1));
  rig.run(2.0);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
  ASSERT_TRUE(rig.move_down(0.3, 0.1));
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
}

TEST(SpeedLimit, of_the_tool_trips)
{
  WholeRig rig;
  SafetyLimits limits;
  limits.tool_speed = 0.25;
  rig.safety.set_limits(limits);
  ASSERT_TRUE(rig.move_down(0.2, 0.4));
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 5.0);
  EXPECT_NE(rig.log().find("safety limit of 0.25 m/s"), std::string::npos);
}

TEST(JointLimits, of_position_and_speed_trip)
{
  const RobotModel & model = testing::model_named("ur10e");
  LimitWatch watch(model, 0.002);
  ControllerState state;
  EXPECT_FALSE(watch.check({}, state));
  state.actual.position[2] = model.position_max[2] + 0.1;
  ASSERT_TRUE(watch.check({}, state));
  EXPECT_NE(watch.check({}, state)->find("joint 2"), std::string::npos);
  state.actual.position[2] = 0.0;
  state.actual.velocity[1] = -1.2 * model.velocity_max[1];
  ASSERT_TRUE(watch.check({}, state));
  EXPECT_NE(watch.check({}, state)->find("joint 1"), std::string::npos);
}

TEST(JointLimits, are_never_tripped_by_a_movej_at_full_speed)
{
  for (const char * name : {"ur3e", "ur10e", "ur20", "ur5"}) {
    WholeRig rig(name);
    ASSERT_TRUE(
        rig.arm.move_joint(default_position(rig.model) + six(2.0, 0.3, 0.3, 1.0, 1.0, 2.0), {40.0, 10.0}));
    rig.run(4.0);
    EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << name << rig.log();
  }
}

TEST(Monitoring, switched_off_trips_on_nothing)
{
  WholeRig rig;
  SafetyLimits limits;
  limits.monitor = false;
  rig.safety.set_limits(limits);
  rig.world.push({six(2000.0, 0, 0, 0, 0, 0), 0.5, false});
  rig.run(1.0);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
}

TEST(MotionFaults, of_the_arm_become_a_protective_stop_that_tells_the_cause)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(0, 0, 0, 0, 0, 3.0), 20.0, 0.0));
  rig.until([&] { return rig.state.safety_mode == SafetyMode::protective_stop; }, 10.0);
  EXPECT_NE(rig.log().find("joint wrist 3 reached its position limit"), std::string::npos);
  EXPECT_EQ(rig.paused, 1);
}

}  // namespace
}  // namespace ur_simulator
