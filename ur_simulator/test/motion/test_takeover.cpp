#include <fmt/format.h>

#include <cmath>

#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::RandomVectors;
using testing::six;

/// Starts a motion of one kind with typical parameters and returns its name.
std::string start_any_motion(ArmFixture & fixture, RandomVectors & random)
{
  const Vector6 target = default_position(fixture.model) + random.six(0.8);
  const double acceleration = 0.2 + std::abs(random.number(5.0));
  const double speed = 0.05 + std::abs(random.number(2.0));
  const Vector6 pose = tcp_pose(fixture.model, target, fixture.state.tcp_offset);
  const Vector6 via =
      tcp_pose(fixture.model, default_position(fixture.model) + random.six(0.8), Vector6::Zero());
  const MoveOptions options{acceleration, speed, 0.0, std::max(0.0, random.number(0.1))};
  switch (random.below(13)) {
    case 0:
      fixture.arm.move_joint(target, options);
      return "movej";
    case 1:
      fixture.arm.move_linear(pose, options);
      return "movel";
    case 8:
      fixture.arm.move_process(pose, options);
      return "movep";
    case 9:
      fixture.arm.move_circular(via, pose, CircleMode::unconstrained, options);
      return "movec";
    case 10:
      fixture.arm.servo_circular(pose, options);
      return "servoc";
    case 11:
      fixture.arm.move_joint_optimally(target, {0.3, 0.3, 0.0, options.blend_radius});
      return "optimovej";
    case 12:
      fixture.arm.move_linear_optimally(pose, {0.3, 0.3, 0.0, options.blend_radius});
      return "optimovel";
    case 2:
      fixture.arm.servo_joint(target, 0.01, 0.1, 300.0);
      return "servoj";
    case 3:
      fixture.arm.speed_joint(random.six(1.5), acceleration, std::abs(random.number(1.0)));
      return "speedj";
    case 4:
      fixture.arm.speed_linear(random.six(0.3), acceleration, std::abs(random.number(1.0)));
      return "speedl";
    case 5:
      fixture.arm.stop_joint(acceleration);
      return "stopj";
    case 6:
      fixture.arm.stop_linear(acceleration);
      return "stopl";
    default:
      fixture.arm.cancel_all();
      return "abandon";
  }
}

class TakeoverOfEveryModelTest : public ::testing::TestWithParam<const char *> {};

// A takeover adds the deceleration of the old motion to the acceleration of the new one. A Cartesian motion
// may use twice the joint acceleration limit of 40 rad/s^2 before it faults.
constexpr double hardest_allowed = 81.0;

TEST_P(TakeoverOfEveryModelTest, VelocityIsContinuousWhenAnyMotionReplacesAnother)
{
  ArmFixture fixture(GetParam());
  RandomVectors random(11);
  int moving = 0;
  for (int i = 0; i < 400; ++i) {
    moving += fixture.state.target.velocity.norm() > 0.05 ? 1 : 0;
    const std::string started = start_any_motion(fixture, random);
    if (random.below(5) == 0) {
      fixture.state.speed_slider = std::abs(random.number(1.0));
    }
    const double time = std::abs(random.number(0.8));
    for (double t = 0.0; t < time; t += fixture.dt) {
      const Vector6 position = fixture.state.target.position;
      fixture.step();
      const Vector6 moved = (fixture.state.target.position - position) / fixture.dt;
      ASSERT_LT(fixture.max_acceleration, hardest_allowed) << i << " " << started;
      ASSERT_TRUE((moved.array().abs() <= fixture.model.velocity_max.array() * 1.001).all())
          << i << " " << started << " " << moved.transpose();
      ASSERT_TRUE((fixture.state.target.position.array() <= fixture.model.position_max.array() + 1e-9).all());
      ASSERT_TRUE((fixture.state.target.position.array() >= fixture.model.position_min.array() - 1e-9).all());
    }
    fixture.arm.take_fault();
  }
  EXPECT_GT(moving, 150) << "too few takeovers in flight to mean anything";
}

TEST_P(TakeoverOfEveryModelTest, VelocityIsContinuousInEveryBlend)
{
  ArmFixture fixture(GetParam());
  RandomVectors random(13);
  int blends = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector6 target = default_position(fixture.model) + random.six(0.6);
    const Vector6 pose = tcp_pose(fixture.model, target, Vector6::Zero());
    const Vector6 via = tcp_pose(fixture.model, target + random.six(0.3), Vector6::Zero());
    const MoveOptions options{0.5 + std::abs(random.number(3.0)), 0.1 + std::abs(random.number(1.0)), 0.0,
                              std::abs(random.number(0.1))};
    StartResult motion;
    switch (random.below(4)) {
      case 0:
        motion = fixture.arm.move_joint(target, options);
        break;
      case 1:
        motion = fixture.arm.move_linear(pose, options);
        break;
      case 2:
        motion = fixture.arm.move_process(pose, options);
        break;
      default:
        motion = fixture.arm.move_circular(via, pose, CircleMode::unconstrained, options);
        break;
    }
    ASSERT_TRUE(motion) << motion.error();
    for (double t = 0.0; !fixture.arm.call_complete(*motion) && t < 30.0; t += fixture.dt) {
      fixture.step();
      ASSERT_LT(fixture.max_acceleration, hardest_allowed) << i;
      ASSERT_TRUE((fixture.max_velocity.array() <= fixture.model.velocity_max.array() * 1.001).all()) << i;
    }
    ASSERT_TRUE(fixture.arm.call_complete(*motion)) << i;
    blends += fixture.arm.in_blend(*motion) ? 1 : 0;
    fixture.arm.take_fault();
  }
  fixture.until_rest(10.0);
  EXPECT_GT(blends, 80) << "too few blends to mean anything";
}

TEST_P(TakeoverOfEveryModelTest, VelocityIsTheDerivativeOfThePosition)
{
  ArmFixture fixture(GetParam());
  RandomVectors random(12);
  for (int i = 0; i < 60; ++i) {
    const std::string started = start_any_motion(fixture, random);
    const double time = std::abs(random.number(0.8));
    for (double t = 0.0; t < time; t += fixture.dt) {
      const Vector6 position = fixture.state.target.position, velocity = fixture.state.target.velocity;
      fixture.step();
      const Vector6 moved = (fixture.state.target.position - position) / fixture.dt;
      const Vector6 mean = 0.5 * (velocity + fixture.state.target.velocity);
      ASSERT_LT((moved - mean).cwiseAbs().maxCoeff(), 0.6 * hardest_allowed * fixture.dt)
          << i << " " << started;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Takeover, TakeoverOfEveryModelTest,
                         ::testing::Values("ur3e", "ur5", "ur10e", "ur18", "ur20"),
                         [](const auto & tested) { return std::string(tested.param); });

TEST(TakeoverTest, MoveJContinuesAtSpeedToTheTargetOfTheNextMoveJ)
{
  ArmFixture fixture;
  const Vector6 home = default_position(fixture.model);
  ASSERT_TRUE(fixture.arm.move_joint(home + six(1.0), {2.0, 1.0}));
  fixture.run(0.8);
  ASSERT_NEAR(fixture.state.target.velocity[0], 1.0, 1e-9);
  fixture.reset_maxima();
  const auto motion = fixture.arm.move_joint(home + six(-0.5), {2.0, 1.0});
  ASSERT_TRUE(motion);
  fixture.step();
  EXPECT_NEAR(fixture.state.target.velocity[0], 1.0, 7.0 * fixture.dt);
  fixture.until_finished(*motion);
  EXPECT_LT(fixture.max_acceleration, 6.1);  // 4 of the residual motion and 2 of the new motion
  EXPECT_EQ(fixture.state.target.position, home + six(-0.5));
}

TEST(TakeoverTest, MoveLEndsAtTheTargetOfTheNextMoveL)
{
  ArmFixture fixture;
  Vector6 first = fixture.tcp(), second = fixture.tcp();
  first[2] -= 0.3;
  second[1] += 0.2;
  second.tail<3>() =
      to_rotation_vector(to_rotation_matrix(second.tail<3>()) * to_rotation_matrix(Vector3(0.1, 0.2, 0.3)));
  ASSERT_TRUE(fixture.arm.move_linear(first, {1.0, 0.3}));
  fixture.run(0.6);
  const auto motion = fixture.arm.move_linear(second, {1.0, 0.3});
  ASSERT_TRUE(motion);
  fixture.until_finished(*motion);
  EXPECT_LT(testing::pose_distance(fixture.tcp(), second), 1e-7);
  EXPECT_FALSE(fixture.arm.take_fault());
}

TEST(TakeoverTest, KeepsTheJointLimitAtHighSpeed)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0, 0, 0, 0, 0, 3.0), 40.0, 0.0));
  fixture.until([&] { return fixture.state.target.position[5] > fixture.model.position_max[5] - 0.5; }, 5.0);
  const auto motion = fixture.arm.move_joint(default_position(fixture.model), {0.1, 0.5});
  ASSERT_TRUE(motion);
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    ASSERT_LE(fixture.state.target.position[5], fixture.model.position_max[5]);
  }
}

}  // namespace
}  // namespace ur_simulator
