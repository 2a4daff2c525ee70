#include <cmath>
#include <numbers>

#include "arm_rig.hpp"
#include "kinematics/inverse.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::ArmRig;
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

TEST(MoveL, leads_the_tool_on_a_straight_line_at_its_speed_to_exactly_its_target)
{
  for (const char * name : {"ur10e", "ur5", "ur20"}) {
    ArmRig rig(name);
    const Vector6 from = rig.tcp();
    Vector6 to = from;
    to[2] -= 0.15;
    to[1] += 0.05;
    const auto motion = rig.arm.move_linear(to, {0.5, 0.1});
    ASSERT_TRUE(motion) << motion.error();
    const double way = (to - from).head<3>().norm();
    double time = 0.0, fastest = 0.0;
    while (!rig.arm.finished(*motion)) {
      rig.step();
      time += rig.dt;
      fastest = std::max(fastest, rig.state.target_tcp_speed.head<3>().norm());
      ASSERT_LT(off_line(from, to, rig.tcp()), 1e-8);
      ASSERT_LT(turn_between(from, rig.tcp()), 1e-7);
    }
    EXPECT_NEAR(time, way / 0.1 + 0.1 / 0.5, 3.0 * rig.dt);
    EXPECT_NEAR(fastest, 0.1, 1e-3);
    EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
    EXPECT_FALSE(rig.arm.take_fault());
  }
}

TEST(MoveL, leads_the_tool_centre_point_that_is_set_and_not_the_flange)
{
  ArmRig rig;
  rig.state.tcp_offset = six(0.05, 0.0, 0.2, 0.0, 0.3, 0.0);
  rig.step();
  const Vector6 from = rig.tcp();
  Vector6 to = from;
  to[0] += 0.1;
  to[2] += 0.1;
  to.tail<3>() = to_rotation_vector(to_rotation(from.tail<3>()) * to_rotation(Vector3(0.2, 0.1, -0.3)));
  const auto motion = rig.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion) << motion.error();
  while (!rig.arm.finished(*motion)) {
    rig.step();
    ASSERT_LT(off_line(from, to, rig.tcp()), 1e-8);
  }
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(MoveL, takes_a_tool_that_was_set_in_the_same_cycle)
{
  ArmRig rig;
  rig.step();
  rig.state.tcp_offset = six(0.0, 0.0, 0.1, 0.0, 0.0, 0.0);
  Vector6 to = forward_tcp(rig.model, rig.state.target.position, rig.state.tcp_offset);
  to[0] += 0.05;
  const auto motion = rig.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion);
  rig.until_finished(*motion);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(MoveL, turns_the_tool_on_the_spot)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  Vector6 to = from;
  to.tail<3>() = to_rotation_vector(to_rotation(from.tail<3>()) * to_rotation(Vector3(0.0, 0.0, 1.0)));
  const auto motion = rig.arm.move_linear(to, {1.2, 0.25});
  ASSERT_TRUE(motion);
  while (!rig.arm.finished(*motion)) {
    rig.step();
    ASSERT_LT((rig.tcp() - from).head<3>().norm(), 1e-8);
  }
  EXPECT_LT(turn_between(rig.tcp(), to), 1e-7);
}

TEST(MoveL, takes_the_time_it_is_given)
{
  ArmRig rig;
  Vector6 to = rig.tcp();
  to[2] -= 0.1;
  const auto motion = rig.arm.move_linear(to, {1.2, 0.25, 2.0});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(rig.until_finished(*motion), 2.0, 2.0 * rig.dt);
}

TEST(MoveL, through_a_wrist_singularity_ends_in_a_fault_and_a_braked_arm)
{
  ArmRig rig;
  Vector6 joints = default_position(rig.model);
  joints << 0.0, -1.3, -1.9, -1.5, 0.15, 0.0;
  rig.arm.teleport(joints, rig.state);
  Vector6 beyond = joints;
  beyond[4] = -0.15;
  beyond[0] = 0.3;
  const Vector6 to = forward_tcp(rig.model, beyond, Vector6::Zero());
  ASSERT_TRUE(rig.arm.move_linear(to, {2.0, 1.0}));
  std::optional<MotionFault> fault;
  rig.until([&] { return (fault = rig.arm.take_fault()).has_value(); }, 5.0);
  EXPECT_EQ(fault->kind, MotionFault::Kind::singularity) << describe(*fault);
  rig.until_rest(1.0);
  EXPECT_TRUE((rig.fastest.array() <= rig.model.velocity_max.array() * 1.000001).all());
}

TEST(MoveL, out_of_reach_on_the_way_ends_in_a_fault)
{
  ArmRig rig;
  // From one side of the base to the other: the line leads through the column that no posture reaches.
  rig.arm.teleport(default_position(rig.model), rig.state);
  Vector6 to = rig.tcp();
  to[0] = -to[0];
  to[1] = -to[1];
  const auto motion = rig.arm.move_linear(to, {1.0, 0.3});
  ASSERT_TRUE(motion) << motion.error();
  std::optional<MotionFault> fault;
  rig.until([&] { return (fault = rig.arm.take_fault()).has_value(); }, 20.0);
  rig.until_rest(1.0);
  EXPECT_TRUE(rig.arm.finished(*motion));
}

TEST(StopL, brings_the_tool_to_rest_on_its_line)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  ASSERT_TRUE(rig.arm.speed_linear(six(0.0, 0.1, -0.1, 0, 0, 0), 0.5, 0.0));
  rig.run(0.5);
  const auto stop = rig.arm.stop_linear(0.5);
  ASSERT_TRUE(stop);
  EXPECT_NEAR(rig.until_finished(*stop), 0.1 * std::sqrt(2.0) / 0.5, 2.0 * rig.dt);
  EXPECT_LT(off_line(from, from + six(0, 1.0, -1.0, 0, 0, 0), rig.tcp()), 2e-5);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
  EXPECT_FALSE(rig.arm.take_fault());
}

TEST(SpeedL, moves_the_tool_with_the_velocity_it_is_told_and_stops_when_time_is_up)
{
  ArmRig rig;
  const auto motion = rig.arm.speed_linear(six(0.05, -0.02, 0.03, 0.0, 0.1, 0.2), 0.5, 1.0);
  ASSERT_TRUE(motion);
  rig.run(0.8);
  EXPECT_LT((rig.state.target_tcp_speed - six(0.05, -0.02, 0.03, 0.0, 0.1, 0.2)).norm(), 2e-3);
  rig.until_finished(*motion);
  rig.until_rest(1.0);
}

TEST(SpeedL, driven_out_of_reach_ends_in_a_fault_and_no_leap)
{
  ArmRig rig;
  ASSERT_TRUE(rig.arm.speed_linear(six(-0.3, 0, 0, 0, 0, 0), 1.0, 0.0));
  std::optional<MotionFault> fault;
  rig.until([&] { return (fault = rig.arm.take_fault()).has_value(); }, 20.0);
  rig.until_rest(1.0);
  EXPECT_TRUE((rig.fastest.array() <= rig.model.velocity_max.array() * 1.000001).all());
}

TEST(Abandon, keeps_the_tool_on_its_line_while_it_brakes)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  Vector6 to = from;
  to[2] -= 0.3;
  const auto motion = rig.arm.move_linear(to, {0.5, 0.2});
  ASSERT_TRUE(motion);
  rig.run(0.7);
  rig.arm.abandon(*motion);
  double braking = 0.0;
  while (!rig.arm.at_rest() && braking < 2.0) {
    rig.step();
    braking += rig.dt;
    ASSERT_LT(off_line(from, to, rig.tcp()), 1e-8);
  }
  EXPECT_TRUE(rig.arm.at_rest());
  EXPECT_LT(braking, 0.2);
  EXPECT_LT(rig.tcp()[2], from[2] - 0.05);
  EXPECT_GT(rig.tcp()[2], to[2] + 0.05);
}

}  // namespace
}  // namespace ur_simulator
