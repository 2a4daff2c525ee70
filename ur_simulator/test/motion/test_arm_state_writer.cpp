#include <chrono>
#include <cmath>

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
  // Lag of the sampled system: the geometric series of the remaining error of each step.
  const double expected = 0.5 * fixture.dt / (std::exp(fixture.dt / JointServoLoop::lag) - 1.0);
  EXPECT_NEAR(behind, expected, 1e-9);
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

TEST(AccelerometerTest, ReadsGravityInTheFlangeFrameAtRest)
{
  ArmFixture fixture;
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
