#include <cmath>
#include <limits>
#include <stdexcept>

#include "arm_rig.hpp"

namespace ur_simulator {
namespace {

using testing::ArmRig;
using testing::six;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

void expect_refused(const MotionStart & start, const char * mentioned)
{
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().find(mentioned), std::string::npos) << start.error();
}

TEST(Refusal, names_call_field_and_value_of_what_is_not_finite)
{
  ArmRig rig;
  Vector6 broken = default_position(rig.model);
  broken[2] = nan_value;
  expect_refused(rig.arm.move_joint(broken, {1.4, 1.05}), "movej: target");
  expect_refused(rig.arm.move_linear(broken, {1.2, 0.25}), "movel: pose");
  expect_refused(rig.arm.servo_joint(broken, 0.002, 0.1, 300.0), "servoj: target");
  expect_refused(rig.arm.speed_joint(broken, 1.0, 0.0), "speedj: velocity");
  expect_refused(rig.arm.speed_linear(broken, 1.0, 0.0), "speedl: velocity");
  expect_refused(rig.arm.stop_joint(nan_value), "stopj: deceleration");
  expect_refused(rig.arm.stop_linear(std::numeric_limits<double>::infinity()), "stopl: deceleration");
  rig.run(0.1);
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(Refusal, names_the_limits_of_what_is_out_of_range)
{
  ArmRig rig;
  const Vector6 home = default_position(rig.model);
  expect_refused(rig.arm.move_joint(home, {0.0, 1.05}), "movej: acceleration must be greater than 0, is 0");
  expect_refused(rig.arm.move_joint(home, {1.4, -1.0}), "movej: velocity must be greater than 0, is -1");
  expect_refused(rig.arm.move_joint(home, {1.4, 1.05, -2.0}), "movej: time");
  expect_refused(rig.arm.move_joint(home, {1.4, 1.05, 0.0, nan_value}), "movej: blend radius");
  expect_refused(rig.arm.servo_joint(home, 0.002, 0.01, 300.0),
                 "servoj: lookahead_time must be in [0.03, 0.2], is 0.01");
  expect_refused(rig.arm.servo_joint(home, 0.002, 0.1, 5000.0),
                 "servoj: gain must be in [100, 2000], is 5000");
  expect_refused(rig.arm.servo_joint(home, -0.002, 0.1, 300.0), "servoj: time");
  expect_refused(rig.arm.speed_joint(home, -1.0, 0.0), "speedj: acceleration");
  expect_refused(rig.arm.stop_joint(0.0), "stopj: deceleration");
}

TEST(Refusal, names_the_joint_that_the_target_would_drive_beyond_its_limits)
{
  ArmRig rig;
  Vector6 beyond = default_position(rig.model);
  beyond[3] = 6.5;
  expect_refused(rig.arm.move_joint(beyond, {1.4, 1.05}), "joint 3 of the target is 6.5000 rad");
  expect_refused(rig.arm.servo_joint(beyond, 0.002, 0.1, 300.0), "joint 3");
}

TEST(Refusal, of_a_movel_out_of_reach_comes_before_it_moves)
{
  ArmRig rig;
  Vector6 far = rig.tcp();
  far[0] = 5.0;
  expect_refused(rig.arm.move_linear(far, {1.2, 0.25}), "out of reach");
  rig.run(0.1);
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(Refusal, leaves_the_motion_that_is_under_way_alone)
{
  ArmRig rig;
  const Vector6 target = default_position(rig.model) + six(0.3);
  const auto motion = rig.arm.move_joint(target, {1.4, 1.05});
  rig.run(0.2);
  EXPECT_FALSE(rig.arm.move_joint(six(nan_value), {1.4, 1.05}));
  EXPECT_TRUE(rig.arm.active(*motion));
  rig.until_finished(*motion);
  EXPECT_EQ(rig.state.target.position, target);
}

TEST(Refusal, names_the_mode_while_the_robot_does_not_run)
{
  ArmRig rig;
  rig.state.robot_mode = RobotMode::idle;
  rig.step();
  expect_refused(rig.arm.move_joint(default_position(rig.model), {1.4, 1.05}), "IDLE");
  rig.state.robot_mode = RobotMode::running;
  rig.state.safety_mode = SafetyMode::protective_stop;
  rig.step();
  expect_refused(rig.arm.speed_joint(six(0.1), 1.0, 0.0), "PROTECTIVE_STOP");
}

TEST(Refusal, comes_before_the_first_cycle_too)
{
  const RobotModel & model = testing::model_named("ur5e");
  Arm arm(model, 0.002, default_position(model));
  expect_refused(arm.move_joint(default_position(model), {1.4, 1.05}), "not started");
}

TEST(PowerLoss, stands_the_arm_where_it_is_and_forgets_the_motion)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(default_position(rig.model) + six(1.0), {1.4, 1.05});
  rig.run(0.5);
  rig.state.robot_mode = RobotMode::power_off;
  rig.step();
  const Vector6 position = rig.state.actual.position;
  rig.run(0.5);
  EXPECT_TRUE(rig.arm.finished(*motion));
  EXPECT_EQ(rig.state.actual.position, position);
  EXPECT_EQ(rig.state.target.position, position);
  EXPECT_TRUE(rig.state.actual.velocity.isZero(0.0));
  EXPECT_TRUE(rig.state.actual.current.isZero(0.0));
  rig.state.robot_mode = RobotMode::running;
  rig.run(0.5);
  EXPECT_EQ(rig.state.target.position, position);
}

TEST(SafetyStop, brakes_the_arm_even_when_nobody_calls_halt)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  rig.run(0.5);
  rig.state.safety_mode = SafetyMode::protective_stop;
  rig.until_rest(0.5);
}

TEST(Teleport, refuses_positions_that_the_arm_cannot_take)
{
  ArmRig rig;
  EXPECT_THROW(rig.arm.teleport(six(nan_value), rig.state), std::invalid_argument);
  EXPECT_THROW(rig.arm.teleport(six(7.0), rig.state), std::invalid_argument);
  EXPECT_THROW(Arm(rig.model, 0.0, Vector6::Zero()), std::invalid_argument);
  EXPECT_THROW(Arm(rig.model, 0.002, six(nan_value)), std::invalid_argument);
  EXPECT_EQ(rig.state.actual.position, default_position(rig.model));
}

}  // namespace
}  // namespace ur_simulator
