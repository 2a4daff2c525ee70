#include "dynamics/dynamics.hpp"
#include "support/robot_fixture.hpp"

namespace ur_simulator::testing {
namespace {

constexpr std::array<bool, 6> all_free{true, true, true, true, true, true};

struct FreedriveTest : ::testing::Test {
  RobotFixture fixture;

  void guide(const std::array<bool, 6> & axes = all_free, const Vector6 & feature = Vector6::Zero())
  {
    const auto started = fixture.arm.start_freedrive(axes, feature);
    ASSERT_TRUE(started) << started.error();
  }
  void push(const Vector6 & wrench, double duration)
  {
    Push hand;
    hand.wrench = wrench;
    hand.duration = duration;
    fixture.world.push(hand);
  }
  Vector3 tcp() const { return fixture.state.actual_tcp_pose.head<3>(); }
};

TEST_F(FreedriveTest, StaysAtRestWithoutForce)
{
  const Vector3 previous = tcp();
  guide();
  fixture.run(2.0);
  EXPECT_LT((tcp() - previous).norm(), 1e-6);
  EXPECT_TRUE(fixture.state.freedrive);
  EXPECT_NE(fixture.state.robot_status_bits & 4u, 0u);
}

TEST_F(FreedriveTest, FollowsAHandAndComesToRest)
{
  const Vector3 previous = tcp();
  guide();
  push(six(0.0, 30.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  fixture.run(1.0);
  const double way = tcp()[1] - previous[1];
  EXPECT_GT(way, 0.05);
  EXPECT_LT(way, 0.6);
  fixture.run(2.0);
  EXPECT_LT(fixture.state.actual_tcp_speed.head<3>().norm(), 1e-3);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << fixture.log();
}

TEST_F(FreedriveTest, ResistsAPushTooWeakForItsFriction)
{
  const Vector3 previous = tcp();
  guide();
  push(six(0.0, 2.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  fixture.run(1.0);
  EXPECT_LT((tcp() - previous).norm(), 2e-3);
}

TEST_F(FreedriveTest, DriftsIfTheLoadDiffersFromThePayload)
{
  const double previous = tcp()[2];
  fixture.world.attach_load({8.0, Vector3::Zero(), Vector6::Zero()});
  guide();
  fixture.run(1.0);
  EXPECT_LT(tcp()[2], previous - 0.02);
}

TEST_F(FreedriveTest, HoldsTheConstrainedAxes)
{
  const Vector6 previous = fixture.state.actual_tcp_pose;
  guide({false, true, false, false, false, false});
  push(six(20.0, 30.0, 30.0, 0.0, 0.0, 2.0), 1.0);
  fixture.run(1.5);
  const Vector6 moved = fixture.state.actual_tcp_pose - previous;
  EXPECT_GT(moved[1], 0.03);
  EXPECT_LT(std::abs(moved[0]), 1e-3);
  EXPECT_LT(std::abs(moved[2]), 1e-3);
  EXPECT_LT(pose_distance((Vector6() << Vector3::Zero(), previous.tail<3>()).finished(),
                          (Vector6() << Vector3::Zero(), fixture.state.actual_tcp_pose.tail<3>()).finished()),
            2e-3);
}

TEST_F(FreedriveTest, TakesItsAxesFromTheFeature)
{
  const Vector3 previous = tcp();
  guide({true, false, false, false, false, false}, six(0.0, 0.0, 0.0, 0.0, 0.0, 0.7853981633974483));
  push(six(0.0, 40.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  fixture.run(1.0);
  const Vector3 moved = tcp() - previous;
  EXPECT_GT(moved.norm(), 0.02);
  EXPECT_NEAR(moved.normalized().dot(Vector3(1.0, 1.0, 0.0).normalized()), 1.0, 1e-3);
}

TEST_F(FreedriveTest, StopsBeforeTheJointLimits)
{
  Vector6 near_the_end = fixture.state.actual.position;
  near_the_end[5] = fixture.model.position_max[5] - 0.3;
  fixture.arm.teleport(near_the_end, fixture.state);
  guide();
  push(six(0.0, 0.0, 0.0, 0.0, 0.0, -30.0), 3.0);
  fixture.run(4.0);
  EXPECT_LE(fixture.state.actual.position[5], fixture.model.position_max[5] + 1e-6);
  EXPECT_GT(fixture.state.actual.position[5], fixture.model.position_max[5] - 0.05);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << fixture.log();
}

TEST_F(FreedriveTest, RejectsMotionsUntilItEnds)
{
  guide();
  const auto rejected = fixture.arm.move_joint(fixture.state.target.position, {1.0, 1.0});
  ASSERT_FALSE(rejected);
  EXPECT_NE(rejected.error().find("freedrive"), std::string::npos);
  fixture.arm.end_freedrive();
  fixture.run(0.1);
  EXPECT_FALSE(fixture.state.freedrive);
  EXPECT_TRUE(fixture.arm.at_rest());
  EXPECT_TRUE(fixture.arm.move_joint(fixture.state.target.position, {1.0, 1.0}));
}

TEST_F(FreedriveTest, EndsAndDeceleratesWithTheProgram)
{
  guide();
  push(six(0.0, 40.0, 0.0, 0.0, 0.0, 0.0), 1.0);
  fixture.run(0.6);
  ASSERT_GT(fixture.state.actual_tcp_speed.head<3>().norm(), 0.05);
  fixture.world.clear_pushes();
  fixture.arm.end_program();
  EXPECT_LT(fixture.until([&] { return fixture.arm.at_rest(); }, 2.0), 0.5);
}

TEST_F(FreedriveTest, EndsInAProtectiveStop)
{
  guide();
  fixture.safety.trigger_protective_stop("a test");
  fixture.run(0.1);
  EXPECT_FALSE(fixture.state.freedrive);
}

struct DirectTorqueTest : ::testing::Test {
  RobotFixture fixture;
  void obey(const Vector6 & torque, double seconds)
  {
    for (double t = 0.0; t < seconds - 0.5 * fixture.dt; t += fixture.dt) {
      const auto started = fixture.arm.direct_torque(torque, six(1.0), six(1.0));
      ASSERT_TRUE(started) << started.error();
      fixture.step();
    }
  }
};

TEST_F(DirectTorqueTest, ZeroHoldsTheArmAgainstGravity)
{
  const Vector6 previous = fixture.state.actual.position;
  obey(Vector6::Zero(), 1.0);
  EXPECT_LT((fixture.state.actual.position - previous).norm(), 1e-6);
}

TEST_F(DirectTorqueTest, AcceleratesAJointAsItsInertiaAllows)
{
  Dynamics dynamics(fixture.model);
  const Matrix6 mass = dynamics.mass_matrix(fixture.state.actual.position);
  const double seconds = 0.1;
  obey(six(20.0, 0.0, 0.0, 0.0, 0.0, 0.0), seconds);
  const double rigid = 20.0 * mass.inverse()(0, 0) * seconds;
  // The mass matrix does not include the inertia of the rotors.
  EXPECT_LT(fixture.state.actual.velocity[0], rigid);
  EXPECT_GT(fixture.state.actual.velocity[0], 0.7 * rigid);
}

TEST_F(DirectTorqueTest, IsAbsorbedByUncompensatedFriction)
{
  const Vector6 torque = six(10.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < 250; ++i) {
    ASSERT_TRUE(fixture.arm.direct_torque(torque, Vector6::Zero(), Vector6::Zero()));
    fixture.step();
  }
  EXPECT_LT(std::abs(fixture.state.actual.velocity[0]), 1e-3);
}

TEST_F(DirectTorqueTest, EndsAtRestIfNoCallFollows)
{
  obey(six(20.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.1);
  ASSERT_GT(fixture.state.actual.velocity[0], 0.2);
  EXPECT_LT(fixture.until([&] { return fixture.arm.at_rest(); }, 1.0), 0.3);
}

TEST_F(DirectTorqueTest, RejectsTorquesAboveTheJointLimit)
{
  const auto rejected = fixture.arm.direct_torque(six(0.0, 0.0, 0.0, 0.0, 0.0, 1000.0), six(1.0), six(1.0));
  ASSERT_FALSE(rejected);
  EXPECT_NE(rejected.error().find("torque[5]"), std::string::npos) << rejected.error();
}

}  // namespace
}  // namespace ur_simulator::testing
