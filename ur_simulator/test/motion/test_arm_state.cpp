#include <chrono>
#include <cmath>

#include "arm_rig.hpp"
#include "dynamics/dynamics.hpp"
#include "motion/follower.hpp"

namespace ur_simulator {
namespace {

using testing::ArmRig;
using testing::six;

TEST(ActualJoints, follow_the_target_with_a_constant_lag)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(0.5, 0, 0, 0, 0, 0), 5.0, 0.0));
  rig.run(1.0);
  const double behind = rig.state.target.position[0] - rig.state.actual.position[0];
  // Sampled: what is left of a cycle's step after the lag, summed up.
  const double expected = 0.5 * rig.dt / (std::exp(rig.dt / Follower::lag) - 1.0);
  EXPECT_NEAR(behind, expected, 1e-9);
  EXPECT_NEAR(rig.state.actual.velocity[0], 0.5, 1e-9);
}

TEST(TcpSpeed, is_the_change_of_the_tcp_pose)
{
  ArmRig rig;
  rig.state.tcp_offset = six(0.1, 0.0, 0.2, 0.0, 0.0, 0.0);
  ASSERT_TRUE(rig.arm.speed_joint(six(0.3, -0.2, 0.2, 0.1, 0.4, 0.5), 5.0, 0.0));
  rig.run(0.5);
  const Vector6 before = rig.state.actual_tcp_pose;
  const Vector6 speed_before = rig.state.actual_tcp_speed;
  rig.step();
  const Vector3 moved = (rig.state.actual_tcp_pose - before).head<3>() / rig.dt;
  EXPECT_LT((moved - 0.5 * (rig.state.actual_tcp_speed + speed_before).head<3>()).norm(), 1e-5);
}

TEST(Accelerometer, reads_gravity_in_flange_axes_at_rest)
{
  ArmRig rig;
  rig.run(0.1);
  // The tool points down: up is along -z of the flange.
  EXPECT_LT((rig.state.tool_acceleration - Vector3(0.0, 0.0, -9.82)).norm(), 1e-6);
}

TEST(Accelerometer, adds_the_acceleration_of_the_flange)
{
  ArmRig rig;
  rig.state.tcp_offset = six(0.0, 0.0, 0.3, 0.0, 0.0, 0.0);  // must not matter
  Vector6 to = forward_tcp(rig.model, rig.state.target.position, rig.state.tcp_offset);
  to[2] -= 0.2;
  rig.step();
  ASSERT_TRUE(rig.arm.move_linear(to, {2.0, 0.5}));
  rig.run(0.15);  // in the middle of the acceleration downwards
  EXPECT_NEAR(rig.state.tool_acceleration.z(), -(9.82 - 2.0), 0.05);
}

TEST(Torques, carry_the_arm_at_rest_and_give_currents_by_the_torque_constant)
{
  ArmRig rig;
  rig.run(0.1);
  Dynamics dynamics(rig.model);
  const Vector6 gravity = dynamics.gravity_torques(rig.state.actual.position);
  EXPECT_LT((rig.state.actual.torque - gravity).norm(), 1e-6);
  EXPECT_LT((rig.state.target.torque - gravity).norm(), 1e-6);
  EXPECT_LT((rig.state.actual.current.cwiseProduct(rig.model.torque_constant) - gravity).norm(), 1e-6);
  EXPECT_GT(std::abs(rig.state.actual.current[1]), 0.5);
}

TEST(Torques, hold_against_what_pushes_at_the_tool)
{
  ArmRig rig;
  rig.run(0.1);
  const Vector6 free = rig.state.actual.torque;
  rig.state.contact_wrench = six(0.0, 0.0, 50.0, 0.0, 0.0, 0.0);  // lifts the tool
  rig.step();
  const Vector6 relief = jacobian(rig.model, rig.state.actual.position, rig.state.tcp_offset).transpose() *
                         rig.state.contact_wrench;
  EXPECT_LT((free - rig.state.actual.torque - relief).norm(), 1e-6);
}

TEST(Payload, shows_in_the_torques_from_the_cycle_it_is_set)
{
  ArmRig rig;
  rig.run(0.1);
  const Vector6 without = rig.state.target.torque;
  rig.state.payload.mass = 5.0;
  rig.step();
  EXPECT_GT((rig.state.target.torque - without).norm(), 10.0);
}

TEST(ControlCycle, of_the_arm_costs_microseconds)
{
  ArmRig rig;
  Vector6 to = rig.tcp();
  to[2] -= 0.3;
  ASSERT_TRUE(rig.arm.move_linear(to, {0.5, 0.05}));
  constexpr int cycles = 2000;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < cycles; ++i) {
    rig.step();
  }
  const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begin;
  RecordProperty("microseconds_per_cycle", std::to_string(spent.count() / cycles));
  std::printf("Arm::step during movel: %.1f us\n", spent.count() / cycles);
  // Far above what it takes (some 10 us optimised), so that a busy machine or a sanitizer does not fail it.
  EXPECT_LT(spent.count() / cycles, 1000.0);
}

}  // namespace
}  // namespace ur_simulator
