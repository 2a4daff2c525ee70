#include "dynamics/dynamics.hpp"
#include "whole_rig.hpp"

namespace ur_simulator::testing {
namespace {

constexpr std::array<bool, 6> all_free{true, true, true, true, true, true};

struct AFreedrive : ::testing::Test {
  WholeRig rig;

  void guide(const std::array<bool, 6> & axes = all_free, const Vector6 & feature = Vector6::Zero())
  {
    const auto started = rig.arm.freedrive(axes, feature);
    ASSERT_TRUE(started) << started.error();
  }
  void push(const Vector6 & wrench, double duration)
  {
    Push hand;
    hand.wrench = wrench;
    hand.duration = duration;
    rig.world.push(hand);
  }
  Vector3 tcp() const { return rig.state.actual_tcp_pose.head<3>(); }
};

TEST_F(AFreedrive, stays_where_it_is_when_nobody_pushes)
{
  const Vector3 before = tcp();
  guide();
  rig.run(2.0);
  EXPECT_LT((tcp() - before).norm(), 1e-6);
  EXPECT_TRUE(rig.state.freedrive);
  EXPECT_NE(rig.state.robot_status_bits & 4u, 0u);
}

TEST_F(AFreedrive, follows_a_hand_and_comes_to_rest_after_it)
{
  const Vector3 before = tcp();
  guide();
  push(six(0.0, 30.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  rig.run(1.0);
  const double way = tcp()[1] - before[1];
  EXPECT_GT(way, 0.05);
  EXPECT_LT(way, 0.6);
  rig.run(2.0);
  EXPECT_LT(rig.state.actual_tcp_speed.head<3>().norm(), 1e-3);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << rig.log();
}

TEST_F(AFreedrive, resists_a_push_too_weak_for_its_friction)
{
  const Vector3 before = tcp();
  guide();
  push(six(0.0, 2.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  rig.run(1.0);
  EXPECT_LT((tcp() - before).norm(), 2e-3);
}

TEST_F(AFreedrive, sinks_when_the_load_is_not_the_payload_it_was_told)
{
  const double before = tcp()[2];
  rig.world.attach_load({8.0, Vector3::Zero(), Vector6::Zero()});
  guide();
  rig.run(1.0);
  EXPECT_LT(tcp()[2], before - 0.02);
}

TEST_F(AFreedrive, keeps_the_axes_that_are_not_free)
{
  const Vector6 before = rig.state.actual_tcp_pose;
  guide({false, true, false, false, false, false});
  push(six(20.0, 30.0, 30.0, 0.0, 0.0, 2.0), 1.0);
  rig.run(1.5);
  const Vector6 moved = rig.state.actual_tcp_pose - before;
  EXPECT_GT(moved[1], 0.03);
  EXPECT_LT(std::abs(moved[0]), 1e-3);
  EXPECT_LT(std::abs(moved[2]), 1e-3);
  EXPECT_LT(pose_distance((Vector6() << Vector3::Zero(), before.tail<3>()).finished(),
                          (Vector6() << Vector3::Zero(), rig.state.actual_tcp_pose.tail<3>()).finished()),
            2e-3);
}

TEST_F(AFreedrive, takes_its_axes_from_the_feature)
{
  const Vector3 before = tcp();
  guide({true, false, false, false, false, false}, six(0.0, 0.0, 0.0, 0.0, 0.0, 0.7853981633974483));
  push(six(0.0, 40.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  rig.run(1.0);
  const Vector3 moved = tcp() - before;
  EXPECT_GT(moved.norm(), 0.02);
  EXPECT_NEAR(moved.normalized().dot(Vector3(1.0, 1.0, 0.0).normalized()), 1.0, 1e-3);
}

TEST_F(AFreedrive, stops_before_the_joint_limits)
{
  Vector6 near_the_end = rig.state.actual.position;
  near_the_end[5] = rig.model.position_max[5] - 0.3;
  rig.arm.teleport(near_the_end, rig.state);
  guide();
  push(six(0.0, 0.0, 0.0, 0.0, 0.0, -30.0), 3.0);
  rig.run(4.0);
  EXPECT_LE(rig.state.actual.position[5], rig.model.position_max[5] + 1e-6);
  EXPECT_GT(rig.state.actual.position[5], rig.model.position_max[5] - 0.05);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << rig.log();
}

TEST_F(AFreedrive, refuses_motions_until_it_ends)
{
  guide();
  const auto refused = rig.arm.move_joint(rig.state.target.position, {1.0, 1.0});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("freedrive"), std::string::npos);
  rig.arm.end_freedrive();
  rig.run(0.1);
  EXPECT_FALSE(rig.state.freedrive);
  EXPECT_TRUE(rig.arm.at_rest());
  EXPECT_TRUE(rig.arm.move_joint(rig.state.target.position, {1.0, 1.0}));
}

TEST_F(AFreedrive, ends_and_brakes_with_its_program)
{
  guide();
  push(six(0.0, 40.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  rig.run(0.6);
  ASSERT_GT(rig.state.actual_tcp_speed.head<3>().norm(), 0.05);
  rig.world.clear_pushes();
  rig.arm.end_program();
  EXPECT_LT(rig.until([&] { return rig.arm.at_rest(); }, 2.0), 0.5);
}

TEST_F(AFreedrive, ends_in_a_protective_stop)
{
  guide();
  rig.safety.trip("a test");
  rig.run(0.1);
  EXPECT_FALSE(rig.state.freedrive);
}

struct ADirectTorque : ::testing::Test {
  WholeRig rig;
  void obey(const Vector6 & torque, double seconds)
  {
    for (double t = 0.0; t < seconds - 0.5 * rig.dt; t += rig.dt) {
      const auto started = rig.arm.direct_torque(torque, six(1.0), six(1.0));
      ASSERT_TRUE(started) << started.error();
      rig.step();
    }
  }
};

TEST_F(ADirectTorque, of_zero_holds_the_arm_against_gravity)
{
  const Vector6 before = rig.state.actual.position;
  obey(Vector6::Zero(), 1.0);
  EXPECT_LT((rig.state.actual.position - before).norm(), 1e-6);
}

TEST_F(ADirectTorque, accelerates_a_joint_as_its_inertia_allows)
{
  Dynamics dynamics(rig.model);
  const Matrix6 mass = dynamics.mass_matrix(rig.state.actual.position);
  const double seconds = 0.1;
  obey(six(20.0, 0.0, 0.0, 0.0, 0.0, 0.0), seconds);
  const double rigid = 20.0 * mass.inverse()(0, 0) * seconds;
  // The rotors' inertia, which the mass matrix leaves out, takes its share.
  EXPECT_LT(rig.state.actual.velocity[0], rigid);
  EXPECT_GT(rig.state.actual.velocity[0], 0.7 * rigid);
}

TEST_F(ADirectTorque, is_swallowed_by_friction_that_is_not_compensated)
{
  const Vector6 torque = six(10.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < 250; ++i) {
    ASSERT_TRUE(rig.arm.direct_torque(torque, Vector6::Zero(), Vector6::Zero()));
    rig.step();
  }
  EXPECT_LT(std::abs(rig.state.actual.velocity[0]), 1e-3);
}

TEST_F(ADirectTorque, ends_at_rest_when_no_call_follows)
{
  obey(six(20.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.1);
  ASSERT_GT(rig.state.actual.velocity[0], 0.2);
  EXPECT_LT(rig.until([&] { return rig.arm.at_rest(); }, 1.0), 0.3);
}

TEST_F(ADirectTorque, refuses_more_than_a_joint_can_give)
{
  const auto refused = rig.arm.direct_torque(six(0.0, 0.0, 0.0, 0.0, 0.0, 1000.0), six(1.0), six(1.0));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("torque[5]"), std::string::npos) << refused.error();
}

}  // namespace
}  // namespace ur_simulator::testing
