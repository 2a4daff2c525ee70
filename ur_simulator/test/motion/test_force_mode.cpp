#include "support/robot_fixture.hpp"

namespace ur_simulator::testing {
namespace {

using Type = ForceModeSettings::Type;

/// Force mode that presses down with `force` N, compliant along z of the base.
ForceModeSettings pressing_down(double force, double speed = 0.05)
{
  ForceModeSettings settings;
  settings.compliant[2] = true;
  settings.wrench[2] = -force;
  settings.limits = six(0.05, 0.05, speed, 0.1, 0.1, 0.1);
  return settings;
}

struct ForceModeTest : ::testing::Test {
  RobotFixture fixture;

  void start(const ForceModeSettings & settings)
  {
    const auto started = fixture.arm.start_force_mode(settings);
    ASSERT_TRUE(started) << started.error();
  }
  double force() const { return fixture.state.contact_wrench[2]; }
  double height() const { return fixture.state.actual_tcp_pose[2]; }
};

TEST_F(ForceModeTest, AppliesTheRequestedForceToASurface)
{
  fixture.world.surfaces().add(fixture.table_below(0.02, 20000.0));
  start(pressing_down(30.0));
  fixture.run(4.0);
  EXPECT_NEAR(force(), 30.0, 0.5);
  double least = force(), most = force();
  for (int i = 0; i < 500; ++i) {
    fixture.step();
    least = std::min(least, force());
    most = std::max(most, force());
  }
  EXPECT_LT(most - least, 0.5);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << fixture.log();
}

TEST_F(ForceModeTest, SettlesOnHardAndSoftSurfacesWithTheGainOfUrRtde)
{
  for (const double stiffness : {2000.0, 20000.0, 200000.0}) {
    RobotFixture other;
    other.world.surfaces().add(other.table_below(0.005, stiffness));
    other.arm.set_force_mode_scaling(0.5);
    ASSERT_TRUE(other.arm.start_force_mode(pressing_down(20.0)));
    other.run(4.0);
    EXPECT_NEAR(other.state.contact_wrench[2], 20.0, 0.5) << stiffness << " N/m";
  }
}

TEST_F(ForceModeTest, ApproachesNoFasterThanItsLimit)
{
  start(pressing_down(50.0, 0.04));
  double max_velocity = 0.0;
  for (int i = 0; i < 1000; ++i) {
    fixture.step();
    max_velocity = std::max(max_velocity, fixture.state.actual_tcp_speed.head<3>().norm());
  }
  EXPECT_NEAR(max_velocity, 0.04, 0.001);
}

TEST_F(ForceModeTest, YieldsToAHandAlongCompliantAxesOnly)
{
  ForceModeSettings settings = pressing_down(0.0, 0.2);
  start(settings);
  const Vector6 previous = fixture.state.actual_tcp_pose;
  Push push;
  push.wrench = six(20.0, 0.0, 20.0, 0.0, 0.0, 0.0);
  push.duration = 1.0;
  fixture.world.push(push);
  fixture.run(1.0);
  const Vector6 moved = fixture.state.actual_tcp_pose - previous;
  EXPECT_GT(moved[2], 0.03);
  EXPECT_LT(std::abs(moved[0]), 0.002);
  EXPECT_LT(moved.tail<3>().norm(), 0.01);
}

TEST_F(ForceModeTest, KeepsItsSpeedWithoutDampingAndLosesItWithFullDamping)
{
  const auto speed_after_a_push = [](double damping) {
    RobotFixture other;
    other.arm.set_force_mode_damping(damping);
    EXPECT_TRUE(other.arm.start_force_mode(pressing_down(0.0, 1.0)));
    Push push;
    push.wrench = six(0.0, 0.0, 20.0, 0.0, 0.0, 0.0);
    other.world.push(push);
    other.run(0.6);
    return other.state.actual_tcp_speed[2];
  };
  EXPECT_GT(speed_after_a_push(0.0), 0.05);
  EXPECT_LT(speed_after_a_push(1.0), 0.005);
}

TEST_F(ForceModeTest, IsSuperposedOnAMove)
{
  fixture.world.surfaces().add(fixture.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  fixture.run(2.0);
  Vector6 target = fixture.state.target_tcp_pose;
  target[1] += 0.2;
  const auto motion = fixture.arm.move_linear(target, {0.5, 0.1});
  ASSERT_TRUE(motion) << motion.error();
  double least = 1e9, most = 0.0;
  fixture.until(
      [&] {
        least = std::min(least, force());
        most = std::max(most, force());
        return fixture.arm.call_complete(*motion);
      },
      5.0);
  EXPECT_NEAR(fixture.state.actual_tcp_pose[1], target[1], 1e-3);
  EXPECT_GT(least, 18.0);
  EXPECT_LT(most, 22.0);
}

TEST_F(ForceModeTest, IgnoresProgramMotionAlongACompliantAxis)
{
  start(pressing_down(0.0));
  const double previous = height();
  Vector6 target = fixture.state.target_tcp_pose;
  target[2] += 0.1;
  target[0] -= 0.05;
  const auto motion = fixture.arm.move_linear(target, {0.5, 0.1});
  ASSERT_TRUE(motion);
  fixture.until([&] { return fixture.arm.call_complete(*motion); }, 5.0);
  fixture.run(0.1);
  EXPECT_NEAR(height(), previous, 0.002);
  EXPECT_NEAR(fixture.state.actual_tcp_pose[0], target[0], 1e-3);
}

TEST_F(ForceModeTest, EndsAtThePresentPosition)
{
  fixture.world.surfaces().add(fixture.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  fixture.run(2.0);
  const double pressed = height();
  fixture.arm.end_force_mode();
  fixture.run(1.0);
  EXPECT_FALSE(fixture.arm.in_force_mode());
  EXPECT_TRUE(fixture.arm.at_rest());
  EXPECT_NEAR(height(), pressed, 5e-4);
  EXPECT_NEAR(fixture.state.target_tcp_pose[2], height(), 1e-5);
}

TEST_F(ForceModeTest, DeceleratesWhenItEndsInMotion)
{
  start(pressing_down(30.0, 0.1));
  fixture.run(1.0);
  ASSERT_NEAR(fixture.state.actual_tcp_speed[2], -0.1, 0.01);
  fixture.arm.end_program();
  const double time = fixture.until([&] { return fixture.arm.at_rest(); }, 2.0);
  EXPECT_GT(time, 0.02);
  EXPECT_LT(time, 0.5);
}

TEST_F(ForceModeTest, TripsAProtectiveStopWhenAnotherAxisDeviatesTooFar)
{
  ForceModeSettings settings = pressing_down(0.0);
  settings.limits[0] = 0.001;
  start(settings);
  Push push;
  push.wrench = six(60.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  push.duration = 0.5;
  fixture.world.push(push);
  fixture.run(0.5);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::protective_stop);
  EXPECT_NE(fixture.log().find("axis 0 of the task frame"), std::string::npos);
}

TEST_F(ForceModeTest, ContinuesAfterAProtectiveStop)
{
  fixture.world.surfaces().add(fixture.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  fixture.run(2.0);
  fixture.safety.trigger_protective_stop("a test");
  fixture.run(6.0);
  EXPECT_TRUE(fixture.arm.at_rest());
  ASSERT_TRUE(fixture.safety.unlock_protective_stop());
  fixture.world.surfaces().clear();
  const double previous = height();
  fixture.run(1.0);
  EXPECT_LT(height(), previous - 0.01);
}

TEST_F(ForceModeTest, OrientsItsFrameToAPoint)
{
  // The y axis of the frame points to the origin: a force along y moves the TCP there.
  ForceModeSettings settings;
  settings.type = Type::to_point;
  settings.frame.head<3>() = fixture.state.actual_tcp_pose.head<3>() + Vector3(0.0, 0.2, 0.2);
  settings.compliant[1] = true;
  settings.wrench[1] = 20.0;
  settings.limits = six(0.05, 0.05, 0.05, 0.1, 0.1, 0.1);
  const Vector6 previous = fixture.state.actual_tcp_pose;
  start(settings);
  fixture.run(1.0);
  const Vector3 moved = (fixture.state.actual_tcp_pose - previous).head<3>();
  EXPECT_GT(moved.norm(), 0.02);
  EXPECT_NEAR(moved.normalized().dot(Vector3(0.0, 1.0, 1.0).normalized()), 1.0, 1e-3);
}

TEST_F(ForceModeTest, AlongMotionHasNoCompliantAxesUntilTheToolMoves)
{
  ForceModeSettings settings;
  settings.type = Type::along_motion;
  settings.compliant[1] = true;
  settings.wrench[1] = 20.0;
  settings.limits = six(0.05, 0.03, 0.05, 0.1, 0.1, 0.1);
  const Vector6 previous = fixture.state.actual_tcp_pose;
  start(settings);
  fixture.run(0.5);
  EXPECT_LT((fixture.state.actual_tcp_pose - previous).norm(), 1e-6);
  ASSERT_TRUE(fixture.arm.speed_linear(six(0.05, 0.0, 0.0, 0.0, 0.0, 0.0), 0.5, 0.0));
  fixture.run(1.0);
  EXPECT_NEAR(fixture.state.actual_tcp_speed[0], 0.05, 1e-3);
  EXPECT_NEAR(fixture.state.actual_tcp_speed[1], 0.03, 1e-3);
}

TEST_F(ForceModeTest, RejectsSettingsThatAreNegativeOrNotFinite)
{
  ForceModeSettings settings = pressing_down(10.0);
  settings.wrench[4] = std::nan("");
  EXPECT_NE(fixture.arm.start_force_mode(settings).error().find("wrench"), std::string::npos);
  settings = pressing_down(10.0);
  settings.limits[3] = -0.1;
  EXPECT_NE(fixture.arm.start_force_mode(settings).error().find("limits[3]"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
