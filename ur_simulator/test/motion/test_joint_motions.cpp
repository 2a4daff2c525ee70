#include <cmath>

#include "arm_rig.hpp"

namespace ur_simulator {
namespace {

using testing::ArmRig;
using testing::six;

Vector6 near_home(const ArmRig & rig, const Vector6 & away)
{
  return default_position(rig.model) + away;
}

TEST(MoveJ, ends_exactly_at_its_target_after_the_time_of_the_longest_way)
{
  ArmRig rig;
  const Vector6 target = near_home(rig, six(0.5, -0.2, 0.3, 0.1, -1.0, 0.4));
  const auto motion = rig.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(motion) << motion.error();
  const double time = rig.until_finished(*motion);
  EXPECT_NEAR(time, 1.0 / 1.05 + 1.05 / 1.4, 2.0 * rig.dt);  // s/v + v/a
  EXPECT_EQ(rig.state.target.position, target);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
  rig.until_rest(0.5);
  EXPECT_LT((rig.state.actual.position - target).norm(), 1e-8);
}

TEST(MoveJ, leads_all_joints_together_with_the_leading_one_at_its_speed_and_acceleration)
{
  ArmRig rig;
  const Vector6 away = six(0.5, -0.2, 0.3, 0.1, -1.0, 0.4);
  const Vector6 start = rig.state.target.position;
  const auto motion = rig.arm.move_joint(start + away, {1.4, 0.8});
  ASSERT_TRUE(motion);
  while (!rig.arm.finished(*motion)) {
    rig.step();
    const Vector6 done = (rig.state.target.position - start).cwiseQuotient(away);
    EXPECT_LT(done.maxCoeff() - done.minCoeff(), 1e-9);
  }
  EXPECT_NEAR(rig.fastest[4], 0.8, 1e-9);
  EXPECT_NEAR(rig.fastest[0], 0.4, 1e-9);
  EXPECT_NEAR(rig.hardest, 1.4, 1e-6);
}

TEST(MoveJ, takes_the_time_it_is_given)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(near_home(rig, six(0.4)), {1.4, 1.05, 2.5});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 2.5, 2.0 * rig.dt);
}

TEST(MoveJ, never_turns_a_joint_faster_than_its_limit)
{
  for (const char * name : {"ur3e", "ur10e", "ur20", "ur5"}) {
    ArmRig rig(name);
    const auto motion = rig.arm.move_joint(near_home(rig, six(3.0, 0.5, 0.5, 0.5, 0.5, 0.5)), {40.0, 100.0});
    ASSERT_TRUE(motion);
    rig.until_finished(*motion);
    EXPECT_NEAR(rig.fastest[0], rig.model.velocity_max[0], 1e-9) << name;
    EXPECT_LE(rig.hardest, 40.0 + 1e-6) << name;
  }
}

TEST(MoveJ, to_where_the_arm_stands_is_over_at_once)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(rig.state.target.position, {1.4, 1.05});
  ASSERT_TRUE(motion);
  EXPECT_LE(rig.until_finished(*motion), 2.0 * rig.dt);
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(MoveJ, takes_twice_the_time_with_the_speed_slider_at_one_half)
{
  ArmRig rig;
  rig.state.speed_slider = 0.5;
  rig.run(1.0);  // the scaling has ramped down
  EXPECT_NEAR(rig.state.speed_scaling, 0.5, 1e-9);
  const auto motion = rig.arm.move_joint(near_home(rig, six(1.0, 0, 0, 0, 0, 0)), {1.4, 1.05});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 2.0 * (1.0 / 1.05 + 1.05 / 1.4), 2.0 * rig.dt);
  EXPECT_NEAR(rig.fastest[0], 0.525, 1e-6);
}

TEST(SpeedSlider, moved_in_the_middle_of_a_motion_changes_its_speed_gradually)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(near_home(rig, six(2.0, 0, 0, 0, 0, 0)), {2.0, 1.0});
  ASSERT_TRUE(motion);
  rig.run(1.0);
  rig.forget_extremes();
  rig.state.speed_slider = 0.0;
  rig.run(1.0);
  EXPECT_LT(rig.hardest, 2.5);
  EXPECT_NEAR(rig.state.target.velocity[0], 0.0, 1e-9);
  EXPECT_FALSE(rig.arm.finished(*motion));
  const double stood_at = rig.state.target.position[0];
  rig.run(1.0);
  EXPECT_DOUBLE_EQ(rig.state.target.position[0], stood_at);
  rig.state.speed_slider = 1.0;
  rig.until_finished(*motion);
  EXPECT_LT(rig.hardest, 2.5);
  EXPECT_NEAR(rig.state.target.position[0], 2.0, 1e-12);
}

TEST(Pause, lets_the_motion_stand_and_resume_ends_it)
{
  ArmRig rig;
  const Vector6 target = near_home(rig, six(1.0, 0, 0, 0, 0, 0));
  const auto motion = rig.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(motion);
  rig.run(0.5);
  rig.arm.pause();
  rig.run(2.0);
  EXPECT_TRUE(rig.state.target.velocity.isZero(1e-9));
  EXPECT_FALSE(rig.arm.finished(*motion));
  rig.arm.resume();
  rig.until_finished(*motion);
  EXPECT_EQ(rig.state.target.position, target);
}

TEST(StopJ, decelerates_the_fastest_joint_as_told_and_keeps_the_direction)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(1.0, 0.5, -0.5, 0, 0, 0), 5.0, 0.0));
  rig.run(0.5);
  const auto stop = rig.arm.stop_joint(2.0);
  ASSERT_TRUE(stop);
  rig.forget_extremes();
  EXPECT_NEAR(rig.until_finished(*stop), 0.5, 2.0 * rig.dt);
  EXPECT_NEAR(rig.hardest, 2.0, 1e-6);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
  rig.until_rest(0.5);
}

TEST(SpeedJ, reaches_its_velocity_and_then_lets_the_call_return_but_goes_on)
{
  ArmRig rig;
  const auto motion = rig.arm.speed_joint(six(0.4, 0, 0, -0.8, 0, 0), 1.6, 0.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 0.5, 2.0 * rig.dt);
  EXPECT_TRUE(rig.arm.active(*motion));
  rig.run(0.5);
  EXPECT_NEAR(rig.state.target.velocity[3], -0.8, 1e-12);
  EXPECT_NEAR(rig.hardest, 1.6, 1e-6);
}

TEST(SpeedJ, comes_to_rest_by_itself_when_its_time_is_up_and_nothing_follows)
{
  ArmRig rig;
  const auto motion = rig.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 1.6, 1.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 1.0, 1.5 * rig.dt);
  EXPECT_NEAR(rig.state.target.velocity[0], 0.4, 1e-12);
  rig.until_rest(0.5);
  EXPECT_FALSE(rig.arm.active(*motion));
}

TEST(SpeedJ, repeated_in_time_goes_on_without_a_dent)
{
  ArmRig rig;
  for (int i = 0; i < 300; ++i) {
    const auto motion = rig.arm.speed_joint(six(0.4, 0, 0, 0, 0, 0), 4.0, 0.008);
    ASSERT_TRUE(motion);
    rig.until_finished(*motion);
    if (i > 30) {
      ASSERT_NEAR(rig.state.target.velocity[0], 0.4, 1e-9) << i;
    }
  }
}

TEST(SpeedJ, stops_at_a_joint_limit_and_reports_which)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(0, 0, 0, 0, 0, 2.0), 10.0, 0.0));
  std::optional<MotionFault> fault;
  rig.until([&] { return (fault = rig.arm.take_fault()).has_value(); }, 10.0);
  EXPECT_EQ(fault->kind, MotionFault::Kind::joint_position_limit);
  EXPECT_EQ(fault->joint, 5);
  EXPECT_NE(describe(*fault).find("wrist 3"), std::string::npos);
  rig.until_rest(1.0);
  EXPECT_LE(rig.state.target.position[5], rig.model.position_max[5]);
  EXPECT_GT(rig.state.target.position[5], rig.model.position_max[5] - 0.01);
  EXPECT_LE(rig.hardest, 40.0 + 1e-6);
}

TEST(ServoJ, tracks_a_moving_target_its_lookahead_time_behind)
{
  ArmRig rig;
  const Vector6 start = rig.state.target.position;
  const double speed = 0.3, lookahead = 0.1;
  for (int i = 0; i < 1000; ++i) {
    const double t = (i + 1) * rig.dt;
    ASSERT_TRUE(rig.arm.servo_joint(start + six(speed * t), rig.dt, lookahead, 300.0));
    rig.step();
  }
  const double behind = (1000 * rig.dt * speed) - (rig.state.target.position[0] - start[0]);
  EXPECT_NEAR(behind / speed, lookahead, 2.0 * rig.dt);
}

TEST(ServoJ, reaches_a_far_target_without_overshoot_or_excess_for_all_parameters)
{
  for (const double gain : {100.0, 300.0, 2000.0}) {
    for (const double lookahead : {0.03, 0.1, 0.2}) {
      for (const char * name : {"ur10e", "ur5"}) {
        ArmRig rig(name);
        const Vector6 target = near_home(rig, six(1.5, 0.3, -0.2, 0.1, 0.5, -1.0));
        ASSERT_TRUE(rig.arm.servo_joint(target, rig.dt, lookahead, gain));
        double beyond = 0.0;
        for (int i = 0; i < 20000 && !rig.arm.at_rest(); ++i) {
          rig.step();
          beyond = std::max(beyond, rig.state.target.position[0] - target[0]);
        }
        EXPECT_TRUE(rig.arm.at_rest()) << gain << " " << lookahead;
        EXPECT_LT(beyond, 0.03) << gain << " " << lookahead;
        EXPECT_LT((rig.state.target.position - target).norm(), 1e-4);
        EXPECT_LE(rig.hardest, 40.0 + 1e-6);
        EXPECT_TRUE((rig.fastest.array() <= rig.model.velocity_max.array() + 1e-9).all());
      }
    }
  }
}

TEST(ServoJ, lets_the_call_return_after_its_time_and_holds_the_target)
{
  ArmRig rig;
  const Vector6 target = near_home(rig, six(0.05));
  const auto motion = rig.arm.servo_joint(target, 0.1, 0.1, 300.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 0.1, 1.5 * rig.dt);
  EXPECT_TRUE(rig.arm.active(*motion));
  rig.run(2.0);
  EXPECT_LT((rig.state.target.position - target).norm(), 1e-5);
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(Abandon, brings_a_servo_in_flight_to_rest)
{
  ArmRig rig;
  const auto motion = rig.arm.servo_joint(near_home(rig, six(1.0)), rig.dt, 0.05, 1000.0);
  ASSERT_TRUE(motion);
  rig.run(0.3);
  ASSERT_GT(rig.state.target.velocity.norm(), 0.5);
  rig.forget_extremes();
  rig.arm.abandon(*motion);
  EXPECT_TRUE(rig.arm.finished(*motion));
  rig.until_rest(2.0);
  EXPECT_LT(rig.hardest, 10.1);
}

TEST(Abandon, of_a_motion_that_was_replaced_leaves_the_new_one_alone)
{
  ArmRig rig;
  const auto first = rig.arm.move_joint(near_home(rig, six(0.5)), {1.4, 1.05});
  rig.run(0.2);
  const Vector6 target = near_home(rig, six(-0.3));
  const auto second = rig.arm.move_joint(target, {1.4, 1.05});
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(rig.arm.finished(*first));
  EXPECT_FALSE(rig.arm.active(*first));
  EXPECT_TRUE(rig.arm.active(*second));
  rig.arm.abandon(*first);
  rig.until_finished(*second);
  EXPECT_EQ(rig.state.target.position, target);
}

TEST(Abandon, stops_even_with_the_speed_slider_at_zero)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(near_home(rig, six(0.5)), {1.4, 1.05});
  ASSERT_TRUE(motion);
  rig.state.speed_slider = 0.0;
  rig.run(1.0);
  rig.arm.abandon(*motion);
  rig.until_rest(2.0);
}

TEST(Halt, brakes_as_hard_as_told_and_forgets_the_motion)
{
  ArmRig rig;
  const auto motion = rig.arm.move_joint(near_home(rig, six(2.0, 0, 0, 0, 0, 0)), {3.0, 1.5});
  ASSERT_TRUE(motion);
  rig.run(0.8);
  rig.forget_extremes();
  rig.arm.halt(20.0);
  EXPECT_TRUE(rig.arm.finished(*motion));
  EXPECT_FALSE(rig.arm.active(*motion));
  const double time = rig.until([&] { return rig.state.target.velocity.isZero(0.0); }, 1.0);
  EXPECT_NEAR(time, 1.5 / 20.0, 2.0 * rig.dt);
  EXPECT_NEAR(rig.hardest, 20.0, 1e-6);
  rig.until_rest(0.5);
}

}  // namespace
}  // namespace ur_simulator
