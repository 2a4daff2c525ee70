#include <cmath>
#include <numbers>

#include "support/path_recorder.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::ArmFixture;
using testing::execute;
using testing::moved;
using testing::pose_distance;
using testing::RecordedPath;
using testing::six;
using testing::Starts;
using testing::turned;

double rotation_between(const Vector6 & a, const Vector6 & b)
{
  return to_rotation_vector(to_rotation_matrix(a.tail<3>()).transpose() * to_rotation_matrix(b.tail<3>()))
      .norm();
}

TEST(MovePTest, KeepsItsSpeedInCircularCorners)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const std::vector<Vector6> corners{moved(from, 0.0, 0.15, 0.0), moved(from, 0.0, 0.15, -0.15),
                                     moved(from, 0.0, 0.0, -0.15), from};
  Starts starts;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double radius = i + 1 < corners.size() ? 0.03 : 0.0;
    starts.push_back(
        [&, i, radius] { return fixture.arm.move_process(corners[i], {1.2, 0.25, 0.0, radius}); });
  }
  const RecordedPath path = execute(fixture, starts);
  const std::size_t ramp = static_cast<std::size_t>(0.25 / 1.2 / fixture.dt) + 2;
  EXPECT_GT(path.min_speed_between(ramp, path.call_complete_at - ramp - 2), 0.2485);
  EXPECT_LT(path.max_speed(), 0.2502);
  // A right angle with 30 mm tangents: the arc has a radius of 30 mm.
  const Vector3 centre = moved(corners[0], 0.0, -0.03, -0.03).head<3>();
  int on_arc = 0;
  for (const Vector6 & pose : path.poses) {
    const Vector3 spoke = pose.head<3>() - centre;
    if (spoke[1] > 1e-3 && spoke[2] > 1e-3) {
      EXPECT_NEAR(spoke.norm(), 0.03, 2e-4);
      ++on_arc;
    }
  }
  EXPECT_NEAR(on_arc * fixture.dt, 0.5 * pi * 0.03 / 0.25, 0.02);
  EXPECT_LT(pose_distance(fixture.tcp(), from), 1e-7);
  EXPECT_LT(fixture.max_acceleration, 40.0);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
}

TEST(MovePTest, RotatesTheToolContinuouslyThroughCorners)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector6 at = turned(moved(from, 0.0, 0.2, 0.0), Vector3(0.0, 0.0, 0.4));
  const Vector6 to = turned(moved(at, 0.0, 0.0, 0.2), Vector3(0.3, 0.0, 0.0));
  execute(fixture, {[&] { return fixture.arm.move_process(at, {1.2, 0.2, 0.0, 0.05}); },
                    [&] { return fixture.arm.move_process(to, {1.2, 0.2}); }});
  EXPECT_LT(fixture.max_acceleration, 20.0);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(MovePTest, SlowsDownWhenItReverses)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp(), at = moved(from, 0.0, 0.2, 0.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_process(at, {1.2, 0.25, 0.0, 0.02}); },
                        [&] { return fixture.arm.move_process(from, {1.2, 0.25}); }});
  EXPECT_LT(path.distance_from(at), 0.02);
  EXPECT_LT(path.max_acceleration(fixture.dt), 20.0) << "either half of the turn: 10 m/s^2 at most";
  EXPECT_LT(pose_distance(fixture.tcp(), from), 1e-7);
}

TEST(MovePTest, StopsAtTheWaypointIfNothingFollows)
{
  ArmFixture fixture;
  const Vector6 to = moved(fixture.tcp(), 0.0, 0.2, 0.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_process(to, {1.2, 0.25, 0.0, 0.005}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
  EXPECT_LT(path.max_acceleration(fixture.dt), 10.0 * 1.02);
}

TEST(MovePTest, JoinsLinesJointMotionsAndCircles)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector6 home = fixture.state.target.position;
  const MoveOptions through{1.2, 0.2, 0.0, 0.02};
  const Vector6 a = moved(from, 0.0, 0.1, 0.0), b = moved(a, 0.0, 0.0, -0.1), c = moved(b, 0.0, -0.2, 0.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(a, through); },
                        [&] { return fixture.arm.move_process(b, through); },
                        [&] {
                          return fixture.arm.move_circular(moved(b, 0.0, -0.1, -0.1), c,
                                                           CircleMode::unconstrained, through);
                        },
                        [&] { return fixture.arm.move_joint(home, {1.4, 1.05}); }});
  for (const Vector6 & waypoint : {a, b, c}) {
    EXPECT_LT(path.distance_from(waypoint), 0.02);
  }
  EXPECT_GT(path.distance_from(a), 1e-3);
  EXPECT_LT(path.distance_from(b), 1e-3) << "the line touches the circle";
  EXPECT_GT(path.distance_from(c), 1e-3);
  EXPECT_EQ(fixture.state.target.position, home);
  EXPECT_LT(fixture.max_acceleration, 40.0);
}

/// A half circle about a center 0.1 m from the TCP.
struct HalfCircle {
  explicit HalfCircle(const ArmFixture & fixture)
      : from(fixture.tcp()),
        via(moved(from, 0.0, 0.1, 0.1)),
        to(moved(from, 0.0, 0.2, 0.0)),
        centre(moved(from, 0.0, 0.1, 0.0).head<3>())
  {
  }
  Vector6 from, via, to;
  Vector3 centre;
};

TEST(MoveCTest, FollowsTheCircleThroughItsPointsAtItsSpeed)
{
  for (const char * name : {"ur10e", "ur5", "ur20"}) {
    ArmFixture fixture(name);
    const HalfCircle half(fixture);
    const RecordedPath path =
        execute(fixture, {[&] {
                  return fixture.arm.move_circular(half.via, half.to, CircleMode::unconstrained, {1.2, 0.2});
                }});
    for (const Vector6 & pose : path.poses) {
      const Vector3 spoke = pose.head<3>() - half.centre;
      ASSERT_NEAR(spoke.norm(), 0.1, 1e-7) << name;
      ASSERT_NEAR(spoke[0], 0.0, 1e-7) << name;
      ASSERT_GT(spoke[2], -1e-7) << name;
      ASSERT_LT(rotation_between(pose, half.from), 1e-6) << name;
    }
    EXPECT_LT(path.distance_from(half.via), 1e-3);
    const double time = static_cast<double>(path.call_complete_at) * fixture.dt;
    EXPECT_NEAR(time, pi * 0.1 / 0.2 + 0.2 / 1.2, 3.0 * fixture.dt) << name;
    const std::size_t ramp = static_cast<std::size_t>(0.2 / 1.2 / fixture.dt) + 2;
    EXPECT_GT(path.min_speed_between(ramp, path.call_complete_at - ramp - 2), 0.199) << name;
    EXPECT_LT(pose_distance(fixture.tcp(), half.to), 1e-7) << name;
  }
}

TEST(MoveCTest, CanExceedAHalfCircle)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector3 centre = moved(from, 0.0, 0.0, -0.1).head<3>();
  const auto on_circle = [&](double angle) {
    Vector6 pose = from;
    pose.head<3>() = centre + 0.1 * Vector3(0.0, std::sin(angle), std::cos(angle));
    return pose;
  };
  const RecordedPath path = execute(fixture, {[&] {
                                      return fixture.arm.move_circular(on_circle(2.0), on_circle(5.0),
                                                                       CircleMode::unconstrained, {1.2, 0.2});
                                    }});
  EXPECT_LT(path.distance_from(on_circle(4.0)), 1e-3);
  EXPECT_GT(path.distance_from(on_circle(5.6)), 0.04);
  EXPECT_LT(pose_distance(fixture.tcp(), on_circle(5.0)), 1e-7);
}

TEST(MoveCTest, FixedModeKeepsTheToolOrientationRelativeToTheTangent)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector3 centre = moved(from, -0.1, 0.0, 0.0).head<3>();
  const auto on_circle = [&](double angle) {
    Vector6 pose = turned(from, Vector3(0.5, 0.2, 0.1));  // the rotation has no effect
    pose.head<3>() = centre + 0.1 * Vector3(std::cos(angle), std::sin(angle), 0.0);
    return pose;
  };
  const RecordedPath path = execute(fixture, {[&] {
                                      return fixture.arm.move_circular(on_circle(0.6), on_circle(1.2),
                                                                       CircleMode::fixed, {1.2, 0.1});
                                    }});
  const Vector3 in_tool_at_start = to_rotation_matrix(from.tail<3>()).transpose() * Vector3::UnitX();
  for (const Vector6 & pose : path.poses) {
    const Vector3 spoke = (pose.head<3>() - centre).normalized();
    ASSERT_LT((to_rotation_matrix(pose.tail<3>()).transpose() * spoke - in_tool_at_start).norm(), 1e-6);
  }
  EXPECT_LT((fixture.tcp() - on_circle(1.2)).head<3>().norm(), 1e-7);
  EXPECT_NEAR(rotation_between(fixture.tcp(), from), 1.2, 1e-6);
}

TEST(MoveCTest, UnconstrainedModeInterpolatesTheToolOrientation)
{
  ArmFixture fixture;
  const HalfCircle half(fixture);
  const Vector6 to = turned(half.to, Vector3(0.0, 0.0, 0.6));
  execute(fixture,
          {[&] { return fixture.arm.move_circular(half.via, to, CircleMode::unconstrained, {1.2, 0.2}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
  EXPECT_LT(fixture.max_acceleration, 20.0);
}

TEST(MoveCTest, IsRejectedForCollinearPoints)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const auto rejected = [&](const Vector6 & via, const Vector6 & to) {
    const auto motion = fixture.arm.move_circular(via, to, CircleMode::unconstrained, {1.2, 0.2});
    return !motion && motion.error().find("must not lie on one line") != std::string::npos;
  };
  EXPECT_TRUE(rejected(moved(from, 0.0, 0.1, 0.0), moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(rejected(from, moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(rejected(moved(from, 0.0, 0.1, 0.1), from));
  EXPECT_TRUE(rejected(moved(from, 0.0, 0.2, 0.0), moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(ServoCTest, FromStandstillMovesStraightToItsTarget)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp(), to = moved(from, 0.0, 0.1, 0.1);
  const RecordedPath path = execute(fixture, {[&] { return fixture.arm.servo_circular(to, {1.2, 0.25}); }});
  EXPECT_LT(path.distance_from(moved(from, 0.0, 0.05, 0.05)), 1e-3);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(ServoCTest, StartsOnTheCircleTangentToItsVelocity)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector6 at = moved(from, 0.0, 0.15, 0.0), to = moved(at, 0.0, 0.1, 0.1);
  // The velocity is along y; the center of the circle is 0.1 m above the start of the servoc.
  const auto first = fixture.arm.servo_circular(at, {1.2, 0.2, 0.0, 0.02});
  ASSERT_TRUE(first);
  fixture.until_finished(*first);
  const Vector3 begun = fixture.tcp().head<3>();
  const Vector3 chord = to.head<3>() - begun;
  const double radius = 0.5 * chord.squaredNorm() / chord[2];
  const Vector3 centre = begun + Vector3(0.0, 0.0, radius);
  fixture.reset_maxima();
  const RecordedPath path = execute(fixture, {[&] { return fixture.arm.servo_circular(to, {1.2, 0.2}); }});
  for (const Vector6 & pose : path.poses) {
    ASSERT_NEAR((pose.head<3>() - centre).norm(), radius, 1e-6);
  }
  EXPECT_LT(fixture.max_acceleration, 20.0);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(ServoCTest, RepeatedForOneTargetComesToRestAtIt)
{
  ArmFixture fixture;
  const Vector6 to = moved(fixture.tcp(), 0.0, 0.15, 0.05);
  for (int call = 0; call < 20; ++call) {
    const auto motion = fixture.arm.servo_circular(to, {1.2, 0.25, 0.0, 0.03});
    ASSERT_TRUE(motion);
    fixture.until_finished(*motion, 5.0);
    fixture.step();
  }
  fixture.until_rest(1.0);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
  EXPECT_LT(fixture.max_acceleration, 40.0);
}

TEST(ServoCTest, WithItsTargetBehindStopsAndReturns)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  ASSERT_TRUE(fixture.arm.servo_circular(moved(from, 0.0, 0.3, 0.0), {1.2, 0.2}));
  fixture.run(0.6);
  const RecordedPath path = execute(fixture, {[&] { return fixture.arm.servo_circular(from, {1.2, 0.2}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), from), 1e-7);
  EXPECT_LT(path.distance_from(from), 1e-6);
  EXPECT_LT(fixture.max_acceleration, 40.0);
}

TEST(OptimoveJTest, ReachesTheGivenFractionOfTheJointSpeed)
{
  for (const double fraction : {0.3, 1.0}) {
    ArmFixture fixture;
    const Vector6 to = fixture.state.target.position + six(2.0, 0.3, 0.1, 0.0, 0.0, 0.5);
    execute(fixture, {[&] { return fixture.arm.move_joint_optimally(to, {fraction, fraction}); }});
    EXPECT_NEAR(fixture.max_velocity[0], fraction * fixture.model.velocity_max[0], 1e-3);
    EXPECT_LT(fixture.max_acceleration, fraction * fixture.model.acceleration_max[0] * 1.001);
    EXPECT_EQ(fixture.state.target.position, to);
  }
}

TEST(OptimoveLTest, IsAsFastAsTheJointLimitsAllow)
{
  for (const char * name : {"ur3e", "ur10e", "ur30"}) {
    ArmFixture fixture(name);
    const Vector6 to = turned(moved(fixture.tcp(), 0.0, 0.2, -0.1), Vector3(0.0, 0.0, 0.5));
    execute(fixture, {[&] { return fixture.arm.move_linear_optimally(to, {1.0, 1.0}); }});
    EXPECT_LT(fixture.max_velocity.cwiseQuotient(fixture.model.velocity_max).maxCoeff(), 1.0) << name;
    EXPECT_LT(fixture.max_acceleration, fixture.model.acceleration_max.maxCoeff()) << name;
    EXPECT_GT(fixture.max_acceleration, 0.3 * fixture.model.acceleration_max.maxCoeff()) << name;
    EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7) << name;
  }
}

TEST(OptimoveTest, RejectsValuesThatAreNoFractions)
{
  ArmFixture fixture;
  const Vector6 pose = fixture.tcp(), joints = fixture.state.target.position;
  EXPECT_FALSE(fixture.arm.move_joint_optimally(joints, {1.5, 0.3}));
  EXPECT_FALSE(fixture.arm.move_joint_optimally(joints, {0.3, 0.0}));
  EXPECT_FALSE(fixture.arm.move_linear_optimally(pose, {0.3, -0.1}));
  EXPECT_EQ(fixture.arm.move_linear_optimally(pose, {2.0, 0.3}).error(),
            "optimovel: a must be in (0, 1], is 2");
}

TEST(PathTest, RejectsInvalidTargetsAndOptions)
{
  ArmFixture fixture;
  const Vector6 pose = moved(fixture.tcp(), 0.0, 0.1, 0.0);
  Vector6 no_number = pose;
  no_number[1] = std::nan("");
  const Vector6 far = moved(pose, 5.0, 0.0, 0.0);
  using Start = StartResult (Arm::*)(const Vector6 &, const MoveOptions &);
  for (const Start start :
       {Start(&Arm::move_process), Start(&Arm::servo_circular), Start(&Arm::move_linear)}) {
    EXPECT_FALSE((fixture.arm.*start)(no_number, {1.2, 0.25}));
    EXPECT_FALSE((fixture.arm.*start)(far, {1.2, 0.25}));
    EXPECT_FALSE((fixture.arm.*start)(pose, {1.2, 0.0}));
    EXPECT_FALSE((fixture.arm.*start)(pose, {0.0, 0.25}));
    EXPECT_FALSE((fixture.arm.*start)(pose, {1.2, 0.25, 0.0, -0.01}));
    EXPECT_FALSE((fixture.arm.*start)(pose, {1.2, 0.25, 0.0, std::nan("")}));
  }
  EXPECT_FALSE(fixture.arm.move_circular(no_number, pose, CircleMode::unconstrained, {1.2, 0.25}));
  EXPECT_FALSE(
      fixture.arm.move_circular(moved(pose, 0.0, 0.0, 0.1), far, CircleMode::unconstrained, {1.2, 0.25}));
  EXPECT_TRUE(fixture.arm.at_rest());
}

}  // namespace
}  // namespace ur_simulator
