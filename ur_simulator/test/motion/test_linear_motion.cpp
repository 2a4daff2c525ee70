#include <cmath>
#include <numbers>

#include "kinematics/inverse_kinematics.hpp"
#include "motion/tcp_kinematics.hpp"
#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::ArmFixture;
using testing::pose_distance;
using testing::six;

/// Distance of a point from the line between two others.
double off_line(const Vector6 & from, const Vector6 & to, const Vector6 & pose)
{
  const Vector3 way = (to - from).head<3>();
  const Vector3 done = (pose - from).head<3>();
  return (done - way.normalized() * done.dot(way.normalized())).norm();
}

double turn_between(Vector6 a, Vector6 b)
{
  a.head<3>().setZero();
  b.head<3>().setZero();
  return pose_distance(a, b);
}

TEST(SpeedSliderTest, ScalesSpeedl)
{
  ArmFixture fixture;
  fixture.state.speed_slider = 0.5;
  fixture.run(1.0);
  const Vector6 start = fixture.tcp();
  const auto motion = fixture.arm.speed_linear(six(0.0, 0.1, 0.0, 0, 0, 0), 0.5, 1.0);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 2.0, 2.0 * fixture.dt);
  EXPECT_NEAR(fixture.tcp()[1] - start[1], 0.1 - 0.01, 1e-3);
}

TEST(MoveLTest, MovesTheToolOnAStraightLineAtItsSpeedToTheTarget)
{
  for (const char * name : {"ur10e", "ur5", "ur20"}) {
    ArmFixture fixture(name);
    const Vector6 from = fixture.tcp();
    Vector6 to = from;
    to[2] -= 0.15;
    to[1] += 0.05;
    const auto motion = fixture.arm.move_linear(to, {0.5, 0.1});
    ASSERT_TRUE(motion) << motion.error();
    const double way = (to - from).head<3>().norm();
    double time = 0.0, max_velocity = 0.0;
    while (!fixture.arm.call_complete(*motion)) {
      fixture.step();
      time += fixture.dt;
      max_velocity = std::max(max_velocity, fixture.state.target_tcp_speed.head<3>().norm());
      ASSERT_LT(off_line(from, to, fixture.tcp()), 1e-8);
      ASSERT_LT(turn_between(from, fixture.tcp()), 1e-7);
    }
    EXPECT_NEAR(time, way / 0.1 + 0.1 / 0.5, 3.0 * fixture.dt);
    EXPECT_NEAR(max_velocity, 0.1, 1e-3);
    EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
    EXPECT_FALSE(fixture.arm.take_fault());
  }
}

TEST(MoveLTest, MovesTheTcpAndNotTheFlange)
{
  ArmFixture fixture;
  fixture.state.tcp_offset = six(0.05, 0.0, 0.2, 0.0, 0.3, 0.0);
  fixture.step();
  const Vector6 from = fixture.tcp();
  Vector6 to = from;
  to[0] += 0.1;
  to[2] += 0.1;
  to.tail<3>() =
      to_rotation_vector(to_rotation_matrix(from.tail<3>()) * to_rotation_matrix(Vector3(0.2, 0.1, -0.3)));
  const auto motion = fixture.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion) << motion.error();
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    ASSERT_LT(off_line(from, to, fixture.tcp()), 1e-8);
  }
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(MoveLTest, UsesATcpThatWasSetInTheSameCycle)
{
  ArmFixture fixture;
  fixture.step();
  fixture.state.tcp_offset = six(0.0, 0.0, 0.1, 0.0, 0.0, 0.0);
  Vector6 to = tcp_pose(fixture.model, fixture.state.target.position, fixture.state.tcp_offset);
  to[0] += 0.05;
  const auto motion = fixture.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion);
  fixture.until_finished(*motion);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(MoveLTest, RotatesTheToolInPlace)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  Vector6 to = from;
  to.tail<3>() =
      to_rotation_vector(to_rotation_matrix(from.tail<3>()) * to_rotation_matrix(Vector3(0.0, 0.0, 1.0)));
  const auto motion = fixture.arm.move_linear(to, {1.2, 0.25});
  ASSERT_TRUE(motion);
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    ASSERT_LT((fixture.tcp() - from).head<3>().norm(), 1e-8);
  }
  EXPECT_LT(turn_between(fixture.tcp(), to), 1e-7);
}

TEST(MoveLTest, TakesTheGivenTime)
{
  ArmFixture fixture;
  Vector6 to = fixture.tcp();
  to[2] -= 0.1;
  const auto motion = fixture.arm.move_linear(to, {1.2, 0.25, 2.0});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(fixture.until_finished(*motion), 2.0, 2.0 * fixture.dt);
}

/// Moves the tool past the base axis, where the base joint would have to turn faster than its limit.
struct FastPassFixture : ArmFixture {
  FastPassFixture()
  {
    Vector6 from = tcp();
    from.head<2>() << 0.45, -0.5;
    to = from;
    to[1] = 0.5;
    const auto joints = get_inverse_kin(model, from, state.target.position, Vector6::Zero());
    arm.teleport(joints.value(), state);
    step();
  }
  Vector6 to;
};

TEST(MoveLTest, SlowsDownWhereAJointWouldBeTooFast)
{
  FastPassFixture fixture;
  const Vector6 from = fixture.tcp();
  const auto motion = fixture.arm.move_linear(fixture.to, {8.0, 2.0});
  ASSERT_TRUE(motion) << motion.error();
  bool limited = false;
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    ASSERT_LT(off_line(from, fixture.to, fixture.tcp()), 1e-8);
    limited = limited || fixture.state.time_scale_source == TimeScaleSource::joint_speed_limit;
  }
  EXPECT_FALSE(fixture.arm.take_fault());
  EXPECT_LT(pose_distance(fixture.tcp(), fixture.to), 1e-6);
  EXPECT_TRUE(limited);
  EXPECT_GT(fixture.max_velocity[0], 0.8 * fixture.model.velocity_max[0]);
  EXPECT_LE(fixture.max_velocity[0], fixture.model.velocity_max[0]);
  EXPECT_EQ(fixture.state.time_scale_source, TimeScaleSource::none);
}

TEST(MoveLTest, TakesLongerThanATimeThatIsTooShortForAJoint)
{
  FastPassFixture fixture;
  const Vector6 from = fixture.tcp();
  const auto motion = fixture.arm.move_linear(fixture.to, {1.2, 0.25, 0.1});
  ASSERT_TRUE(motion) << motion.error();
  while (!fixture.arm.call_complete(*motion)) {
    fixture.step();
    ASSERT_LT(off_line(from, fixture.to, fixture.tcp()), 1e-8);
  }
  const auto fault = fixture.arm.take_fault();
  EXPECT_FALSE(fault) << describe(*fault);
  EXPECT_LT(pose_distance(fixture.tcp(), fixture.to), 1e-6);
  EXPECT_TRUE((fixture.max_velocity.array() <= fixture.model.velocity_max.array()).all());
}

TEST(MoveLTest, IsNotSlowedDownWithinTheJointSpeedLimits)
{
  FastPassFixture fixture;
  const auto motion = fixture.arm.move_linear(fixture.to, {1.2, 0.25});
  ASSERT_TRUE(motion) << motion.error();
  // 1 m at 0.25 m/s with ramps of 1.2 m/s^2
  EXPECT_NEAR(fixture.until_finished(*motion), 1.0 / 0.25 + 0.25 / 1.2, 3.0 * fixture.dt);
  EXPECT_FALSE(fixture.arm.take_fault());
}

TEST(MoveLTest, ThroughAWristSingularityFaultsAndStops)
{
  ArmFixture fixture;
  Vector6 joints = default_position(fixture.model);
  joints << 0.0, -1.3, -1.9, -1.5, 0.15, 0.0;
  fixture.arm.teleport(joints, fixture.state);
  Vector6 beyond = joints;
  beyond[4] = -0.15;
  beyond[0] = 0.3;
  const Vector6 to = tcp_pose(fixture.model, beyond, Vector6::Zero());
  ASSERT_TRUE(fixture.arm.move_linear(to, {2.0, 1.0}));
  std::optional<MotionFault> fault;
  fixture.until([&] { return (fault = fixture.arm.take_fault()).has_value(); }, 5.0);
  EXPECT_EQ(fault->kind, MotionFault::Kind::singularity) << describe(*fault);
  fixture.until_rest(1.0);
  EXPECT_TRUE((fixture.max_velocity.array() <= fixture.model.velocity_max.array() * 1.000001).all());
}

TEST(MoveLTest, TheFaultNamesTheQuantityThatIsTooLarge)
{
  const RobotModel & model = find_robot_model("ur10e")->get();
  const TcpKinematics kinematics(model, Vector6::Zero());
  const Setpoint begin{default_position(model), Vector6::Zero()};
  constexpr double duration = 0.002;
  const auto fault_of_step = [&](double base_speed) {
    Setpoint setpoint = begin;
    Vector6 joints = begin.position;
    joints[0] += base_speed * duration;
    return kinematics.move_to(kinematics.tcp_pose(joints), duration, setpoint).value();
  };
  EXPECT_EQ(describe(fault_of_step(1.0)),
            "joint base would have to accelerate at 500 rad/s^2 (limit 80 rad/s^2); move slower");
  EXPECT_EQ(describe(fault_of_step(5.0)),
            "joint base would have to turn at 5.00 rad/s (limit 2.09 rad/s); move slower");
}

TEST(MoveLTest, FaultsIfThePathIsOutOfReach)
{
  ArmFixture fixture;
  // The line passes through the cylinder about the base axis, which the arm cannot reach.
  fixture.arm.teleport(default_position(fixture.model), fixture.state);
  Vector6 to = fixture.tcp();
  to[0] = -to[0];
  to[1] = -to[1];
  const auto motion = fixture.arm.move_linear(to, {1.0, 0.3});
  ASSERT_TRUE(motion) << motion.error();
  std::optional<MotionFault> fault;
  fixture.until([&] { return (fault = fixture.arm.take_fault()).has_value(); }, 20.0);
  fixture.until_rest(1.0);
  EXPECT_TRUE(fixture.arm.call_complete(*motion));
}

TEST(StopLTest, StopsTheToolOnItsLine)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  ASSERT_TRUE(fixture.arm.speed_linear(six(0.0, 0.1, -0.1, 0, 0, 0), 0.5, 0.0));
  fixture.run(0.5);
  const auto stop = fixture.arm.stop_linear(0.5);
  ASSERT_TRUE(stop);
  EXPECT_NEAR(fixture.until_finished(*stop), 0.1 * std::sqrt(2.0) / 0.5, 2.0 * fixture.dt);
  EXPECT_LT(off_line(from, from + six(0, 1.0, -1.0, 0, 0, 0), fixture.tcp()), 2e-5);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
  EXPECT_FALSE(fixture.arm.take_fault());
}

TEST(SpeedLTest, MovesTheToolAtTheVelocityAndStopsWhenTheTimeIsUp)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.speed_linear(six(0.05, -0.02, 0.03, 0.0, 0.1, 0.2), 0.5, 1.0);
  ASSERT_TRUE(motion);
  fixture.run(0.8);
  EXPECT_LT((fixture.state.target_tcp_speed - six(0.05, -0.02, 0.03, 0.0, 0.1, 0.2)).norm(), 2e-3);
  fixture.until_finished(*motion);
  fixture.until_rest(1.0);
}

TEST(SpeedLTest, OutOfReachFaultsWithoutAJump)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_linear(six(-0.3, 0, 0, 0, 0, 0), 1.0, 0.0));
  std::optional<MotionFault> fault;
  fixture.until([&] { return (fault = fixture.arm.take_fault()).has_value(); }, 20.0);
  fixture.until_rest(1.0);
  EXPECT_TRUE((fixture.max_velocity.array() <= fixture.model.velocity_max.array() * 1.000001).all());
}

TEST(CancelTest, KeepsTheToolOnItsLineWhileItDecelerates)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  Vector6 to = from;
  to[2] -= 0.3;
  const auto motion = fixture.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion);
  fixture.run(0.7);
  fixture.arm.cancel(*motion);
  double braking = 0.0;
  while (!fixture.arm.at_rest() && braking < 2.0) {
    fixture.step();
    braking += fixture.dt;
    ASSERT_LT(off_line(from, to, fixture.tcp()), 1e-8);
  }
  EXPECT_TRUE(fixture.arm.at_rest());
  EXPECT_LT(braking, 0.2);
  EXPECT_LT(fixture.tcp()[2], from[2] - 0.05);
  EXPECT_GT(fixture.tcp()[2], to[2] + 0.05);
}

}  // namespace
}  // namespace ur_simulator
