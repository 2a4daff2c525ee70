#include <cmath>

#include "support/path_recorder.hpp"

namespace ur_simulator {
namespace {

using testing::ArmFixture;
using testing::execute;
using testing::moved;
using testing::pose_distance;
using testing::RecordedPath;
using testing::six;
using testing::turned;

/// Two lines at a right angle.
struct Corner {
  explicit Corner(const ArmFixture & fixture)
      : from(fixture.tcp()), at(moved(from, 0.0, 0.2, 0.0)), to(moved(at, 0.0, 0.0, -0.2))
  {
  }
  double off_its_lines(const Vector6 & pose) const
  {
    const auto off = [&](const Vector6 & a, const Vector6 & b) {
      const Vector3 along = (b - a).head<3>().normalized(), way = (pose - a).head<3>();
      return (way - along * along.dot(way)).norm();
    };
    return std::min(off(from, at), off(at, to));
  }
  Vector6 from, at, to;
};

TEST(BlendTest, BetweenLinesIsAParabola)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const MoveOptions through{1.2, 0.25, 0.0, 0.05};
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(corner.at, through); },
                        [&] { return fixture.arm.move_linear(corner.to, {1.2, 0.25}); }});
  // In the middle of the blend the distance from the waypoint along each line is a quarter of the radius.
  EXPECT_NEAR(path.distance_from(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  for (const Vector6 & pose : path.poses) {
    if ((pose - corner.at).head<3>().norm() > 0.0501) {
      ASSERT_LT(corner.off_its_lines(pose), 1e-7);
    }
  }
  EXPECT_GT(path.min_speed_between(path.motion_starts[1], path.motion_starts[1] + 200),
            0.25 / std::sqrt(2.0) - 2e-3);
  EXPECT_LT(path.max_speed(), 0.2501);
  EXPECT_LT(path.max_acceleration(fixture.dt), 1.2 * 1.01)
      << "0.25 m/s are turned by 90 degrees in 0.4 s: 0.88 m/s^2";
  EXPECT_LT(pose_distance(fixture.tcp(), corner.to), 1e-7);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
}

TEST(BlendTest, OnAStraightLineKeepsTheSpeed)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp(), at = moved(from, 0.0, 0.2, 0.0), to = moved(from, 0.0, 0.4, 0.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(at, {1.2, 0.25, 0.0, 0.04}); },
                        [&] { return fixture.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_GT(path.min_speed_between(110, path.call_complete_at - 110), 0.247);
  EXPECT_LT(path.max_speed(), 0.2501);
  EXPECT_NEAR(static_cast<double>(path.call_complete_at) * fixture.dt, 0.4 / 0.25 + 0.25 / 1.2, 0.01);
}

TEST(BlendTest, CallReturnsWhereTheBlendBegins)
{
  ArmFixture fixture;
  const Vector6 to = moved(fixture.tcp(), 0.0, 0.2, 0.0);
  const auto motion = fixture.arm.move_linear(to, {1.2, 0.25, 0.0, 0.03});
  ASSERT_TRUE(motion);
  EXPECT_FALSE(fixture.arm.in_blend(*motion));
  fixture.until_finished(*motion);
  EXPECT_TRUE(fixture.arm.in_blend(*motion));
  EXPECT_NEAR((fixture.tcp() - to).head<3>().norm(), 0.03, 0.25 * fixture.dt);
}

TEST(BlendTest, EndsAtTheWaypointIfNothingFollows)
{
  ArmFixture fixture;
  const Vector6 to = moved(fixture.tcp(), 0.0, 0.2, 0.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(to, {1.2, 0.25, 0.0, 0.03}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
  EXPECT_LT(path.max_acceleration(fixture.dt), 1.2 * 1.01);
}

TEST(BlendTest, IsSmallerIfTheNextMotionStartsLate)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const auto first = fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  ASSERT_TRUE(first);
  fixture.until_finished(*first);
  fixture.run(0.25);  // of 0.4 s
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_GT(path.distance_from(corner.at), 1e-4);
  EXPECT_LT(path.distance_from(corner.at), 0.008);
  EXPECT_LT(path.max_acceleration(fixture.dt), 2.0 * 1.2 * 1.01);
  EXPECT_LT(pose_distance(fixture.tcp(), corner.to), 1e-7);
}

TEST(BlendTest, BetweenJointMotionsIsInJointSpace)
{
  ArmFixture fixture;
  const Vector6 from = fixture.state.target.position;
  const Vector6 at = from + six(0.6, 0.0, 0.0, 0.0, 0.0, 0.0), to = at + six(0.0, 0.3, -0.3, 0.0, 0.0, 0.0);
  const Vector6 waypoint = tcp_pose(fixture.model, at, Vector6::Zero());
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_joint(at, {1.4, 1.05, 0.0, 0.1}); },
                        [&] { return fixture.arm.move_joint(to, {1.4, 1.05}); }});
  EXPECT_GT(path.distance_from(waypoint), 0.005);
  EXPECT_LT(path.distance_from(waypoint), 0.1);
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    if ((path.poses[i] - waypoint).head<3>().norm() > 0.105) {
      const double off_first = std::abs(path.joints[i][1] - from[1]);
      const double off_second = std::abs(path.joints[i][0] - at[0]);
      ASSERT_LT(std::min(off_first, off_second), 1e-9);
    }
    ASSERT_NEAR(path.joints[i][5], from[5], 1e-12) << "joints that do not move, move in no blend either";
  }
  EXPECT_LT(fixture.max_acceleration, 1.4 * 1.01) << "each joint moves in one of the two motions";
  EXPECT_GT(path.min_speed_between(path.motion_starts[1], path.motion_starts[1] + 50), 0.1);
  EXPECT_EQ(fixture.state.target.position, to);
  EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
}

TEST(BlendTest, JoinsJointMotionsAndLinesInEitherOrder)
{
  for (const bool joint_first : {true, false}) {
    ArmFixture fixture;
    const Vector6 from = fixture.state.target.position;
    Vector6 beside = from;
    beside[0] += 0.4;
    const Vector6 at =
        joint_first ? tcp_pose(fixture.model, beside, Vector6::Zero()) : moved(fixture.tcp(), 0.0, 0.15, 0.0);
    const auto joint = [&](const Vector6 & target, double r) {
      return [&, target, r] { return fixture.arm.move_joint(target, {1.4, 1.05, 0.0, r}); };
    };
    const auto line = [&](const Vector6 & target, double r) {
      return [&, target, r] { return fixture.arm.move_linear(target, {1.2, 0.25, 0.0, r}); };
    };
    const Vector6 above = moved(at, 0.0, 0.0, 0.2);
    const RecordedPath path = joint_first ? execute(fixture, {joint(beside, 0.04), line(above, 0.0)})
                                          : execute(fixture, {line(at, 0.04), joint(beside, 0.0)});
    EXPECT_LT(path.distance_from(at), 0.04) << joint_first;
    EXPECT_GT(path.distance_from(at), 1e-3) << joint_first;
    EXPECT_GT(path.min_speed_between(path.motion_starts[1], path.motion_starts[1] + 50), 0.05) << joint_first;
    EXPECT_LT(fixture.max_acceleration, 40.0) << joint_first;
    if (joint_first) {
      EXPECT_LT(pose_distance(fixture.tcp(), above), 1e-7);
    } else {
      EXPECT_EQ(fixture.state.target.position, beside);
    }
    EXPECT_TRUE(fixture.state.target.velocity.isZero(0.0));
  }
}

TEST(BlendTest, RotatesTheToolContinuously)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  const Vector6 at = turned(moved(from, 0.0, 0.2, 0.0), Vector3(0.0, 0.0, 0.3));
  const Vector6 to = turned(moved(at, 0.0, 0.0, 0.2), Vector3(0.2, 0.0, -0.2));
  execute(fixture, {[&] { return fixture.arm.move_linear(at, {1.2, 0.25, 0.0, 0.05}); },
                    [&] { return fixture.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_LT(fixture.max_acceleration, 20.0);
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
}

TEST(BlendTest, OverlappingThePreviousBlendSkipsTheWaypoint)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const Vector6 close = moved(corner.at, 0.03, 0.0, 0.0);
  bool is_skipped = false;
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
                        [&] {
                          const auto skipped = fixture.arm.move_linear(close, {1.2, 0.25, 0.0, 0.02});
                          is_skipped = skipped && *skipped == skipped_motion_id;
                          return skipped;
                        },
                        [&] { return fixture.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_TRUE(is_skipped);
  EXPECT_NEAR(path.distance_from(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  EXPECT_LT(pose_distance(fixture.tcp(), corner.to), 1e-7);
}

TEST(BlendTest, AsWideAsTheWholePathSkipsTheWaypoint)
{
  ArmFixture fixture;
  const auto motion = fixture.arm.move_linear(moved(fixture.tcp(), 0.0, 0.01, 0.0), {1.2, 0.25, 0.0, 0.02});
  ASSERT_TRUE(motion);
  EXPECT_EQ(*motion, skipped_motion_id);
  EXPECT_TRUE(fixture.arm.call_complete(*motion));
  EXPECT_TRUE(fixture.arm.at_rest());
}

TEST(BlendTest, NeverSkipsAWaypointWithoutBlend)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const Vector6 close = moved(corner.at, 0.0, 0.0, -0.02);
  execute(fixture, {[&] { return fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
                    [&] { return fixture.arm.move_linear(close, {1.2, 0.25}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), close), 1e-7);
}

TEST(BlendTest, FollowsTheSamePathAtHalfTheSpeed)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  fixture.state.speed_slider = 0.5;
  fixture.run(1.0);
  const RecordedPath path =
      execute(fixture, {[&] { return fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
                        [&] { return fixture.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_NEAR(path.distance_from(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  EXPECT_LT(path.max_speed(), 0.1251);
}

TEST(BlendTest, StaysOnItsPathWhenItDecelerates)
{
  ArmFixture fixture, undisturbed;
  const Corner corner(fixture);
  const MoveOptions through{1.2, 0.25, 0.0, 0.05};
  const RecordedPath way =
      execute(undisturbed, {[&] { return undisturbed.arm.move_linear(corner.at, through); },
                            [&] { return undisturbed.arm.move_linear(corner.to, {1.2, 0.25}); }});
  const auto first = fixture.arm.move_linear(corner.at, through);
  fixture.until_finished(*first);
  const auto second = fixture.arm.move_linear(corner.to, {1.2, 0.25});
  ASSERT_TRUE(second);
  fixture.run(0.15);
  fixture.arm.cancel(*second);
  fixture.until_rest(0.5);
  EXPECT_LT(way.distance_from(fixture.tcp()), 3e-4);
  EXPECT_GT((fixture.tcp() - corner.to).head<3>().norm(), 0.1);
}

TEST(BlendTest, StopsWhileTheProgramIsPaused)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const auto first = fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  fixture.until_finished(*first);
  const auto second = fixture.arm.move_linear(corner.to, {1.2, 0.25});
  fixture.run(0.1);
  fixture.arm.pause();
  fixture.run(1.0);
  const Vector6 paused = fixture.tcp();
  fixture.run(0.5);
  EXPECT_LT(pose_distance(fixture.tcp(), paused), 1e-9);
  fixture.arm.resume();
  fixture.until_finished(*second);
  EXPECT_LT(pose_distance(fixture.tcp(), corner.to), 1e-7);
  EXPECT_LT(fixture.max_acceleration, 20.0);
}

TEST(BlendTest, MiddleIsPassedAtTheTimeOfATimedMotion)
{
  ArmFixture fixture;
  const Vector6 from = fixture.tcp();
  Vector6 at = from;
  testing::Starts starts;
  for (int i = 1; i <= 4; ++i) {
    at = moved(from, 0.0, 0.1 * i, 0.0);
    starts.push_back(
        [&fixture, at, i] { return fixture.arm.move_linear(at, {1.2, 0.25, 0.5, i < 4 ? 0.02 : 0.0}); });
  }
  const RecordedPath path = execute(fixture, starts);
  // On a straight line the TCP passes the waypoint in the middle of the blend.
  const auto passes = [&](double y) {
    std::size_t i = 0;
    while (i < path.poses.size() && path.poses[i][1] - from[1] < y) {
      ++i;
    }
    return static_cast<double>(i) * fixture.dt;
  };
  EXPECT_NEAR(passes(0.1), 0.5, 0.01);
  EXPECT_NEAR(passes(0.2), 1.0, 0.01);
  EXPECT_NEAR(passes(0.3), 1.5, 0.01);
}

TEST(BlendTest, DoesNotBlendMotionsWithDifferentTcps)
{
  ArmFixture fixture;
  const Corner corner(fixture);
  const auto first = fixture.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  fixture.until_finished(*first);
  fixture.state.tcp_offset = six(0.0, 0.0, 0.1, 0.0, 0.0, 0.0);
  const Vector6 to =
      moved(tcp_pose(fixture.model, fixture.state.target.position, fixture.state.tcp_offset), 0, 0, 0.1);
  execute(fixture, {[&] { return fixture.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_LT(pose_distance(fixture.tcp(), to), 1e-7);
  EXPECT_LT(fixture.max_acceleration, 40.0);
}

}  // namespace
}  // namespace ur_simulator
