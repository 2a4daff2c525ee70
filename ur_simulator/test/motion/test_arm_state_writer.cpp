#include <chrono>
#include <cmath>
#include <numbers>

#include "dynamics/dynamics.hpp"
#include "motion/joint_servo_loop.hpp"
#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::six;

TEST(JointServoLoopTest, FollowsTheTargetWithAConstantLag)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0.5, 0, 0, 0, 0, 0), 5.0, 0.0));
  fixture.run(1.0);
  const double behind = fixture.state.target.position[0] - fixture.state.actual.position[0];
  EXPECT_NEAR(behind, 0.5 * JointServoLoop::lag(fixture.model.series), 1e-9);
  EXPECT_NEAR(fixture.state.actual.velocity[0], 0.5, 1e-9);
}

TEST(TcpSpeedTest, IsTheDerivativeOfTheTcpPose)
{
  ArmFixture fixture;
  fixture.state.tcp_offset = six(0.1, 0.0, 0.2, 0.0, 0.0, 0.0);
  ASSERT_TRUE(fixture.arm.speed_joint(six(0.3, -0.2, 0.2, 0.1, 0.4, 0.5), 5.0, 0.0));
  fixture.run(0.5);
  const Vector6 previous = fixture.state.actual_tcp_pose;
  const Vector6 speed_before = fixture.state.actual_tcp_speed;
  fixture.step();
  const Vector3 moved = (fixture.state.actual_tcp_pose - previous).head<3>() / fixture.dt;
  EXPECT_LT((moved - 0.5 * (fixture.state.actual_tcp_speed + speed_before).head<3>()).norm(), 1e-5);
}

TEST(TcpAccelerationTest, IsTheDerivativeOfTheTcpSpeed)
{
  ArmFixture fixture;
  Vector6 to = fixture.tcp();
  to[2] -= 0.2;
  fixture.step();
  ASSERT_TRUE(fixture.arm.move_linear(to, {2.0, 0.5}));
  fixture.run(0.1);  // while the arm accelerates downwards
  EXPECT_NEAR(fixture.state.target_tcp_acceleration[2], -2.0, 0.02);
  EXPECT_NEAR(fixture.state.actual_tcp_acceleration[2], -2.0, 0.02);
  fixture.until_rest();
  fixture.run(0.5);
  EXPECT_LT(fixture.state.actual_tcp_acceleration.norm(), 1e-6);
}

TEST(ElbowTest, IsAtTheEndOfTheUpperArm)
{
  ArmFixture fixture;
  fixture.arm.teleport(six(0.0, -1.5707963267948966, 0.0, 0.0, 0.0, 0.0), fixture.state);
  fixture.step();
  const Vector3 upright(0.0, 0.0, fixture.model.d[0] - fixture.model.a[1]);
  EXPECT_LT((fixture.state.elbow_position - upright).norm(), 1e-9);
}

TEST(ElbowTest, VelocityIsTheDerivativeOfThePosition)
{
  ArmFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(0.3, -0.2, 0.2, 0.1, 0.4, 0.5), 5.0, 0.0));
  fixture.run(0.5);
  const Vector3 position = fixture.state.elbow_position;
  const Vector3 velocity = fixture.state.elbow_velocity;
  fixture.step();
  const Vector3 moved = (fixture.state.elbow_position - position) / fixture.dt;
  EXPECT_LT((moved - 0.5 * (fixture.state.elbow_velocity + velocity)).norm(), 1e-5);
  EXPECT_GT(velocity.norm(), 0.05);
}

TEST(BaseWrenchTest, CarriesTheWeightOfArmAndPayloadAtRest)
{
  ArmFixture fixture;
  fixture.state.payload.mass = 5.0;
  fixture.step();
  double mass = 5.0;
  for (const Link & link : fixture.model.links) {
    mass += link.mass;
  }
  EXPECT_LT((fixture.state.target_base_wrench.head<3>() - Vector3(0.0, 0.0, 9.82 * mass)).norm(), 1e-6);
}

TEST(EnergyTest, LiftingConsumesAndLoweringDissipatesThePotentialEnergy)
{
  ArmFixture fixture;
  Vector6 lower = fixture.tcp(), upper = lower;
  lower[2] -= 0.2;
  fixture.state.payload.mass = 10.0;
  fixture.step();
  const Dynamics dynamics = [&] {
    Dynamics result(fixture.model);
    result.set_payload(fixture.state.payload);
    return result;
  }();
  const double high = dynamics.potential_energy(fixture.state.actual.position);
  ASSERT_TRUE(fixture.arm.move_linear(lower, {0.5, 0.1}));
  fixture.until_rest();
  const double low = dynamics.potential_energy(fixture.state.actual.position);
  const Energy lowered = fixture.state.energy;
  // Joints that drive while others brake add the same energy to both sums.
  EXPECT_NEAR(lowered.braking_dissipated - lowered.consumed, high - low, 0.5);
  EXPECT_GT(lowered.braking_dissipated, 15.0);
  ASSERT_TRUE(fixture.arm.move_linear(upper, {0.5, 0.1}));
  fixture.until_rest();
  const double consumed = fixture.state.energy.consumed - lowered.consumed;
  const double dissipated = fixture.state.energy.braking_dissipated - lowered.braking_dissipated;
  EXPECT_NEAR(consumed - dissipated, high - low, 0.5);
}

TEST(AccelerometerTest, ReadsGravityInTheFlangeFrameAtRest)
{
  ArmFixture fixture;
  const double half_pi = 0.5 * std::numbers::pi;
  fixture.arm.teleport(six(0.0, -half_pi, half_pi, -half_pi, -half_pi, 0.0), fixture.state);
  fixture.run(0.1);
  // The tool points down: up is -z of the flange.
  EXPECT_LT((fixture.state.tool_acceleration - Vector3(0.0, 0.0, -9.82)).norm(), 1e-6);
}

TEST(AccelerometerTest, AddsTheAccelerationOfTheFlange)
{
  ArmFixture fixture;
  fixture.state.tcp_offset = six(0.0, 0.0, 0.3, 0.0, 0.0, 0.0);  // must have no effect
  Vector6 to = tcp_pose(fixture.model, fixture.state.target.position, fixture.state.tcp_offset);
  to[2] -= 0.2;
  fixture.step();
  ASSERT_TRUE(fixture.arm.move_linear(to, {2.0, 0.5}));
  fixture.run(0.15);  // while the arm accelerates downwards
  EXPECT_NEAR(fixture.state.tool_acceleration.z(), -(9.82 - 2.0), 0.05);
}

TEST(JointTorqueTest, CarryTheArmAtRestAndDetermineTheCurrents)
{
  ArmFixture fixture;
  fixture.run(0.1);
  Dynamics dynamics(fixture.model);
  const Vector6 gravity = dynamics.gravity_torques(fixture.state.actual.position);
  EXPECT_LT((fixture.state.actual.torque - gravity).norm(), 1e-6);
  EXPECT_LT((fixture.state.target.torque - gravity).norm(), 1e-6);
  EXPECT_LT((fixture.state.actual.current.cwiseProduct(fixture.model.torque_constant) - gravity).norm(),
            1e-6);
  EXPECT_GT(std::abs(fixture.state.actual.current[1]), 0.5);
}

TEST(JointTorqueTest, CounteractAForceAtTheTool)
{
  ArmFixture fixture;
  fixture.run(0.1);
  const Vector6 free = fixture.state.actual.torque;
  fixture.state.contact_wrench = six(0.0, 0.0, 50.0, 0.0, 0.0, 0.0);  // lifts the tool
  fixture.step();
  const Vector6 relief =
      jacobian(fixture.model, fixture.state.actual.position, fixture.state.tcp_offset).transpose() *
      fixture.state.contact_wrench;
  EXPECT_LT((free - fixture.state.actual.torque - relief).norm(), 1e-6);
}

TEST(PayloadTest, AffectsTheTorquesFromTheCycleItIsSet)
{
  ArmFixture fixture;
  fixture.run(0.1);
  const Vector6 without = fixture.state.target.torque;
  fixture.state.payload.mass = 5.0;
  fixture.step();
  EXPECT_GT((fixture.state.target.torque - without).norm(), 10.0);
}

TEST(ControlCycleTest, OfTheArmTakesMicroseconds)
{
  ArmFixture fixture;
  Vector6 to = fixture.tcp();
  to[2] -= 0.3;
  ASSERT_TRUE(fixture.arm.move_linear(to, {0.5, 0.05}));
  constexpr int cycles = 2000;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < cycles; ++i) {
    fixture.step();
  }
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begin;
  RecordProperty("microseconds_per_cycle", std::to_string(spent.count() / cycles));
  std::printf("Arm::step during movel: %.1f us\n", spent.count() / cycles);
  // A cycle takes about 10 us in a release build; the limit tolerates a busy machine and sanitizers.
  EXPECT_LT(spent.count() / cycles, 1000.0);
}

}  // namespace
}  // namespace ur_simulator
