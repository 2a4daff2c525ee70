#include "whole_rig.hpp"

namespace ur_simulator::testing {
namespace {

using Type = ForceModeSettings::Type;

/// Presses down with `force` N, compliant along z of the base.
ForceModeSettings pressing_down(double force, double speed = 0.05)
{
  ForceModeSettings settings;
  settings.compliant[2] = true;
  settings.wrench[2] = -force;
  settings.limits = six(0.05, 0.05, speed, 0.1, 0.1, 0.1);
  return settings;
}

struct AForceMode : ::testing::Test {
  WholeRig rig;

  void start(const ForceModeSettings & settings)
  {
    const auto started = rig.arm.start_force_mode(settings);
    ASSERT_TRUE(started) << started.error();
  }
  double force() const { return rig.state.contact_wrench[2]; }
  double height() const { return rig.state.actual_tcp_pose[2]; }
};

TEST_F(AForceMode, holds_the_force_it_was_asked_for_against_a_surface)
{
  rig.world.place_surface(rig.table_below(0.02, 20000.0));
  start(pressing_down(30.0));
  rig.run(4.0);
  EXPECT_NEAR(force(), 30.0, 0.5);
  double least = force(), most = force();
  for (int i = 0; i < 500; ++i) {
    rig.step();
    least = std::min(least, force());
    most = std::max(most, force());
  }
  EXPECT_LT(most - least, 0.5);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << rig.log();
}

TEST_F(AForceMode, settles_on_hard_and_on_soft_surfaces_at_the_gain_of_ur_rtde)
{
  for (const double stiffness : {2000.0, 20000.0, 200000.0}) {
    WholeRig other;
    other.world.place_surface(other.table_below(0.005, stiffness));
    other.arm.set_force_mode_scaling(0.5);
    ASSERT_TRUE(other.arm.start_force_mode(pressing_down(20.0)));
    other.run(4.0);
    EXPECT_NEAR(other.state.contact_wrench[2], 20.0, 0.5) << stiffness << " N/m";
  }
}

TEST_F(AForceMode, approaches_no_faster_than_its_limit)
{
  start(pressing_down(50.0, 0.04));
  double fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    rig.step();
    fastest = std::max(fastest, rig.state.actual_tcp_speed.head<3>().norm());
  }
  EXPECT_NEAR(fastest, 0.04, 0.001);
}

TEST_F(AForceMode, gives_way_to_a_hand_along_compliant_axes_only)
{
  ForceModeSettings settings = pressing_down(0.0, 0.2);
  start(settings);
  const Vector6 before = rig.state.actual_tcp_pose;
  Push push;
  push.wrench = six(20.0, 0.0, 20.0, 0.0, 0.0, 0.0);
  push.duration = 1.0;
  rig.world.push(push);
  rig.run(1.0);
  const Vector6 moved = rig.state.actual_tcp_pose - before;
  EXPECT_GT(moved[2], 0.03);
  EXPECT_LT(std::abs(moved[0]), 0.002);
  EXPECT_LT(moved.tail<3>().norm(), 0.01);
}

TEST_F(AForceMode, keeps_its_speed_without_damping_and_loses_it_with_full_damping)
{
  const auto speed_after_a_push = [](double damping) {
    WholeRig other;
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

TEST_F(AForceMode, is_superposed_on_a_move)
{
  rig.world.place_surface(rig.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  rig.run(2.0);
  Vector6 target = rig.state.target_tcp_pose;
  target[1] += 0.2;
  const auto motion = rig.arm.move_linear(target, {0.5, 0.1});
  ASSERT_TRUE(motion) << motion.error();
  double least = 1e9, most = 0.0;
  rig.until(
      [&] {
        least = std::min(least, force());
        most = std::max(most, force());
        return rig.arm.finished(*motion);
      },
      5.0);
  EXPECT_NEAR(rig.state.actual_tcp_pose[1], target[1], 1e-3);
  EXPECT_GT(least, 18.0);
  EXPECT_LT(most, 22.0);
}

TEST_F(AForceMode, ignores_what_the_program_moves_along_a_compliant_axis)
{
  start(pressing_down(0.0));
  const double before = height();
  Vector6 target = rig.state.target_tcp_pose;
  target[2] += 0.1;
  target[0] -= 0.05;
  const auto motion = rig.arm.move_linear(target, {0.5, 0.1});
  ASSERT_TRUE(motion);
  rig.until([&] { return rig.arm.finished(*motion); }, 5.0);
  rig.run(0.1);
  EXPECT_NEAR(height(), before, 0.002);
  EXPECT_NEAR(rig.state.actual_tcp_pose[0], target[0], 1e-3);
}

TEST_F(AForceMode, ends_where_the_arm_is)
{
  rig.world.place_surface(rig.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  rig.run(2.0);
  const double pressed = height();
  rig.arm.end_force_mode();
  rig.run(1.0);
  EXPECT_FALSE(rig.arm.in_force_mode());
  EXPECT_TRUE(rig.arm.at_rest());
  EXPECT_NEAR(height(), pressed, 5e-4);
  EXPECT_NEAR(rig.state.target_tcp_pose[2], height(), 1e-5);
}

TEST_F(AForceMode, brakes_when_it_ends_in_motion)
{
  start(pressing_down(30.0, 0.1));
  rig.run(1.0);
  ASSERT_NEAR(rig.state.actual_tcp_speed[2], -0.1, 0.01);
  rig.arm.end_program();
  const double time = rig.until([&] { return rig.arm.at_rest(); }, 2.0);
  EXPECT_GT(time, 0.02);
  EXPECT_LT(time, 0.5);
}

TEST_F(AForceMode, trips_a_protective_stop_when_another_axis_deviates_too_far)
{
  ForceModeSettings settings = pressing_down(0.0);
  settings.limits[0] = 0.001;
  start(settings);
  Push push;
  push.wrench = six(60.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  push.duration = 0.5;
  rig.world.push(push);
  rig.run(0.5);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::protective_stop);
  EXPECT_NE(rig.log().find("axis 0 of the task frame"), std::string::npos);
}

TEST_F(AForceMode, waits_during_a_protective_stop_and_goes_on_after_it)
{
  rig.world.place_surface(rig.table_below(0.01, 20000.0));
  start(pressing_down(20.0));
  rig.run(2.0);
  rig.safety.trip("a test");
  rig.run(6.0);
  EXPECT_TRUE(rig.arm.at_rest());
  ASSERT_TRUE(rig.safety.unlock_protective_stop());
  rig.world.clear_surfaces();
  const double before = height();
  rig.run(1.0);
  EXPECT_LT(height(), before - 0.01);
}

TEST_F(AForceMode, turns_its_frame_to_a_point)
{
  // y of the frame points to the origin: a force along y leads the TCP there.
  ForceModeSettings settings;
  settings.type = Type::to_point;
  settings.frame.head<3>() = rig.state.actual_tcp_pose.head<3>() + Vector3(0.0, 0.2, 0.2);
  settings.compliant[1] = true;
  settings.wrench[1] = 20.0;
  settings.limits = six(0.05, 0.05, 0.05, 0.1, 0.1, 0.1);
  const Vector6 before = rig.state.actual_tcp_pose;
  start(settings);
  rig.run(1.0);
  const Vector3 moved = (rig.state.actual_tcp_pose - before).head<3>();
  EXPECT_GT(moved.norm(), 0.02);
  EXPECT_NEAR(moved.normalized().dot(Vector3(0.0, 1.0, 1.0).normalized()), 1.0, 1e-3);
}

TEST_F(AForceMode, along_the_motion_has_no_compliant_axes_until_the_tool_moves)
{
  ForceModeSettings settings;
  settings.type = Type::along_motion;
  settings.compliant[1] = true;
  settings.wrench[1] = 20.0;
  settings.limits = six(0.05, 0.03, 0.05, 0.1, 0.1, 0.1);
  const Vector6 before = rig.state.actual_tcp_pose;
  start(settings);
  rig.run(0.5);
  EXPECT_LT((rig.state.actual_tcp_pose - before).norm(), 1e-6);
  ASSERT_TRUE(rig.arm.speed_linear(six(0.05, 0.0, 0.0, 0.0, 0.0, 0.0), 0.5, 0.0));
  rig.run(1.0);
  EXPECT_NEAR(rig.state.actual_tcp_speed[0], 0.05, 1e-3);
  EXPECT_NEAR(rig.state.actual_tcp_speed[1], 0.03, 1e-3);
}

TEST_F(AForceMode, refuses_settings_that_are_not_finite_or_negative)
{
  ForceModeSettings settings = pressing_down(10.0);
  settings.wrench[4] = std::nan("");
  EXPECT_NE(rig.arm.start_force_mode(settings).error().find("wrench"), std::string::npos);
  settings = pressing_down(10.0);
  settings.limits[3] = -0.1;
  EXPECT_NE(rig.arm.start_force_mode(settings).error().find("limits[3]"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
