#include <fmt/format.h>

#include <cmath>

#include "arm_rig.hpp"

namespace ur_simulator {
namespace {

using testing::ArmRig;
using testing::RandomVectors;
using testing::six;

/// Starts one motion of any kind with parameters such as programs use; the name of what it started.
std::string start_any_motion(ArmRig & rig, RandomVectors & random)
{
  const Vector6 target = default_position(rig.model) + random.six(0.8);
  const double acceleration = 0.2 + std::abs(random.number(5.0));
  const double speed = 0.05 + std::abs(random.number(2.0));
  const Vector6 pose = forward_tcp(rig.model, target, rig.state.tcp_offset);
  const Vector6 via = forward_tcp(rig.model, default_position(rig.model) + random.six(0.8), Vector6::Zero());
  const MoveOptions options{acceleration, speed, 0.0, std::max(0.0, random.number(0.1))};
  switch (random.below(13)) {
    case 0:
      rig.arm.move_joint(target, options);
      return "movej";
    case 1:
      rig.arm.move_linear(pose, options);
      return "movel";
    case 8:
      rig.arm.move_process(pose, options);
      return "movep";
    case 9:
      rig.arm.move_circular(via, pose, CircleMode::unconstrained, options);
      return "movec";
    case 10:
      rig.arm.servo_circular(pose, options);
      return "servoc";
    case 11:
      rig.arm.move_joint_optimally(target, {0.3, 0.3, 0.0, options.blend_radius});
      return "optimovej";
    case 12:
      rig.arm.move_linear_optimally(pose, {0.3, 0.3, 0.0, options.blend_radius});
      return "optimovel";
    case 2:
      rig.arm.servo_joint(target, 0.01, 0.1, 300.0);
      return "servoj";
    case 3:
      rig.arm.speed_joint(random.six(1.5), acceleration, std::abs(random.number(1.0)));
      return "speedj";
    case 4:
      rig.arm.speed_linear(random.six(0.3), acceleration, std::abs(random.number(1.0)));
      return "speedl";
    case 5:
      rig.arm.stop_joint(acceleration);
      return "stopj";
    case 6:
      rig.arm.stop_linear(acceleration);
      return "stopl";
    default:
      rig.arm.abandon_all();
      return "abandon";
  }
}

class AnyModel : public ::testing::TestWithParam<const char *> {};

// The takeover adds the deceleration of the old motion to the acceleration of the new one; what follows a
// Cartesian path may use twice the joints' acceleration limit of 40 rad/s^2 before it faults.
constexpr double hardest_allowed = 81.0;

TEST_P(AnyModel, never_leaps_whatever_motion_replaces_whatever_other)
{
  ArmRig rig(GetParam());
  RandomVectors random(11);
  int moving = 0;
  for (int i = 0; i < 400; ++i) {
    moving += rig.state.target.velocity.norm() > 0.05 ? 1 : 0;
    const std::string started = start_any_motion(rig, random);
    if (random.below(5) == 0) {
      rig.state.speed_slider = std::abs(random.number(1.0));
    }
    const double time = std::abs(random.number(0.8));
    for (double t = 0.0; t < time; t += rig.dt) {
      const Vector6 position = rig.state.target.position;
      rig.step();
      const Vector6 moved = (rig.state.target.position - position) / rig.dt;
      ASSERT_LT(rig.hardest, hardest_allowed) << i << " " << started;
      ASSERT_TRUE((moved.array().abs() <= rig.model.velocity_max.array() * 1.001).all())
          << i << " " << started << " " << moved.transpose();
      ASSERT_TRUE((rig.state.target.position.array() <= rig.model.position_max.array() + 1e-9).all());
      ASSERT_TRUE((rig.state.target.position.array() >= rig.model.position_min.array() - 1e-9).all());
    }
    rig.arm.take_fault();
  }
  EXPECT_GT(moving, 150) << "too few takeovers in flight to mean anything";
}

TEST_P(AnyModel, never_leaps_in_a_blend_of_whatever_with_whatever)
{
  ArmRig rig(GetParam());
  RandomVectors random(13);
  int blends = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector6 target = default_position(rig.model) + random.six(0.6);
    const Vector6 pose = forward_tcp(rig.model, target, Vector6::Zero());
    const Vector6 via = forward_tcp(rig.model, target + random.six(0.3), Vector6::Zero());
    const MoveOptions options{0.5 + std::abs(random.number(3.0)), 0.1 + std::abs(random.number(1.0)), 0.0,
                              std::abs(random.number(0.1))};
    MotionStart motion;
    switch (random.below(4)) {
      case 0:
        motion = rig.arm.move_joint(target, options);
        break;
      case 1:
        motion = rig.arm.move_linear(pose, options);
        break;
      case 2:
        motion = rig.arm.move_process(pose, options);
        break;
      default:
        motion = rig.arm.move_circular(via, pose, CircleMode::unconstrained, options);
        break;
    }
    ASSERT_TRUE(motion) << motion.error();
    for (double t = 0.0; !rig.arm.finished(*motion) && t < 30.0; t += rig.dt) {
      rig.step();
      ASSERT_LT(rig.hardest, hardest_allowed) << i;
      ASSERT_TRUE((rig.fastest.array() <= rig.model.velocity_max.array() * 1.001).all()) << i;
    }
    ASSERT_TRUE(rig.arm.finished(*motion)) << i;
    blends += rig.arm.in_blend(*motion) ? 1 : 0;
    rig.arm.take_fault();
  }
  rig.until_rest(10.0);
  EXPECT_GT(blends, 80) << "too few blends to mean anything";
}

TEST_P(AnyModel, has_a_velocity_that_is_the_change_of_its_position)
{
  ArmRig rig(GetParam());
  RandomVectors random(12);
  for (int i = 0; i < 60; ++i) {
    const std::string started = start_any_motion(rig, random);
    const double time = std::abs(random.number(0.8));
    for (double t = 0.0; t < time; t += rig.dt) {
      const Vector6 position = rig.state.target.position, velocity = rig.state.target.velocity;
      rig.step();
      const Vector6 moved = (rig.state.target.position - position) / rig.dt;
      const Vector6 mean = 0.5 * (velocity + rig.state.target.velocity);
      ASSERT_LT((moved - mean).cwiseAbs().maxCoeff(), 0.6 * hardest_allowed * rig.dt) << i << " " << started;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Takeover, AnyModel, ::testing::Values("ur3e", "ur5", "ur10e", "ur18", "ur20"),
                         [](const auto & tested) { return std::string(tested.param); });

TEST(Takeover, of_a_movej_by_another_goes_on_at_speed_and_ends_at_the_new_target)
{
  ArmRig rig;
  const Vector6 home = default_position(rig.model);
  ASSERT_TRUE(rig.arm.move_joint(home + six(1.0), {2.0, 1.0}));
  rig.run(0.8);
  ASSERT_NEAR(rig.state.target.velocity[0], 1.0, 1e-9);
  rig.forget_extremes();
  const auto motion = rig.arm.move_joint(home + six(-0.5), {2.0, 1.0});
  ASSERT_TRUE(motion);
  rig.step();
  EXPECT_NEAR(rig.state.target.velocity[0], 1.0, 7.0 * rig.dt);
  rig.until_finished(*motion);
  EXPECT_LT(rig.hardest, 6.1);  // 4 of the runout and 2 of the new motion
  EXPECT_EQ(rig.state.target.position, home + six(-0.5));
}

TEST(Takeover, of_a_movel_by_a_movel_ends_exactly_at_the_new_target)
{
  ArmRig rig;
  Vector6 first = rig.tcp(), second = rig.tcp();
  first[2] -= 0.3;
  second[1] += 0.2;
  second.tail<3>() = to_rotation_vector(to_rotation(second.tail<3>()) * to_rotation(Vector3(0.1, 0.2, 0.3)));
  ASSERT_TRUE(rig.arm.move_linear(first, {1.0, 0.3}));
  rig.run(0.6);
  const auto motion = rig.arm.move_linear(second, {1.0, 0.3});
  ASSERT_TRUE(motion);
  rig.until_finished(*motion);
  EXPECT_LT(testing::pose_distance(rig.tcp(), second), 1e-7);
  EXPECT_FALSE(rig.arm.take_fault());
}

TEST(Takeover, at_high_speed_near_a_joint_limit_stays_within_it)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(0, 0, 0, 0, 0, 3.0), 40.0, 0.0));
  rig.until([&] { return rig.state.target.position[5] > rig.model.position_max[5] - 0.5; }, 5.0);
  const auto motion = rig.arm.move_joint(default_position(rig.model), {0.1, 0.5});
  ASSERT_TRUE(motion);
  while (!rig.arm.finished(*motion)) {
    rig.step();
    ASSERT_LE(rig.state.target.position[5], rig.model.position_max[5]);
  }
}

}  // namespace
}  // namespace ur_simulator
