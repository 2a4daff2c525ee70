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
  switch (random.below(8)) {
    case 0:
      rig.arm.move_joint(target, {acceleration, speed});
      return "movej";
    case 1:
      rig.arm.move_linear(forward_tcp(rig.model, target, rig.state.tcp_offset), {acceleration, speed});
      return "movel";
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
