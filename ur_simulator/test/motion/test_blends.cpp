#include <cmath>

#include "path_track.hpp"

namespace ur_simulator {
namespace {

using testing::ArmRig;
using testing::drive;
using testing::moved;
using testing::pose_distance;
using testing::six;
using testing::Track;
using testing::turned;

/// Two lines at a right angle.
struct Corner {
  explicit Corner(const ArmRig & rig)
      : from(rig.tcp()), at(moved(from, 0.0, 0.2, 0.0)), to(moved(at, 0.0, 0.0, -0.2))
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

TEST(ABlend, between_lines_is_a_parabola_about_the_waypoint)
{
  ArmRig rig;
  const Corner corner(rig);
  const MoveOptions through{1.2, 0.25, 0.0, 0.05};
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(corner.at, through); },
                                  [&] { return rig.arm.move_linear(corner.to, {1.2, 0.25}); }});
  // Halfway through the blend half of either side of the corner is left, and a quarter of the radius covered.
  EXPECT_NEAR(track.nearest(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  for (const Vector6 & pose : track.poses) {
    if ((pose - corner.at).head<3>().norm() > 0.0501) {
      ASSERT_LT(corner.off_its_lines(pose), 1e-7);
    }
  }
  EXPECT_GT(track.slowest_between(track.begun[1], track.begun[1] + 200), 0.25 / std::sqrt(2.0) - 2e-3);
  EXPECT_LT(track.fastest(), 0.2501);
  EXPECT_LT(track.hardest(rig.dt), 1.2 * 1.01) << "0.25 m/s are turned by 90 degrees in 0.4 s: 0.88 m/s^2";
  EXPECT_LT(pose_distance(rig.tcp(), corner.to), 1e-7);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
}

TEST(ABlend, straight_on_keeps_the_speed)
{
  ArmRig rig;
  const Vector6 from = rig.tcp(), at = moved(from, 0.0, 0.2, 0.0), to = moved(from, 0.0, 0.4, 0.0);
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(at, {1.2, 0.25, 0.0, 0.04}); },
                                  [&] { return rig.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_GT(track.slowest_between(110, track.arrived - 110), 0.247);
  EXPECT_LT(track.fastest(), 0.2501);
  EXPECT_NEAR(static_cast<double>(track.arrived) * rig.dt, 0.4 / 0.25 + 0.25 / 1.2, 0.01);
}

TEST(ABlend, lets_the_program_go_on_where_it_begins)
{
  ArmRig rig;
  const Vector6 to = moved(rig.tcp(), 0.0, 0.2, 0.0);
  const auto motion = rig.arm.move_linear(to, {1.2, 0.25, 0.0, 0.03});
  ASSERT_TRUE(motion);
  EXPECT_FALSE(rig.arm.in_blend(*motion));
  rig.until_finished(*motion);
  EXPECT_TRUE(rig.arm.in_blend(*motion));
  EXPECT_NEAR((rig.tcp() - to).head<3>().norm(), 0.03, 0.25 * rig.dt);
}

TEST(ABlend, that_nothing_follows_ends_at_the_waypoint)
{
  ArmRig rig;
  const Vector6 to = moved(rig.tcp(), 0.0, 0.2, 0.0);
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(to, {1.2, 0.25, 0.0, 0.03}); }});
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
  EXPECT_LT(track.hardest(rig.dt), 1.2 * 1.01);
}

TEST(ABlend, that_something_follows_late_is_cut_less)
{
  ArmRig rig;
  const Corner corner(rig);
  const auto first = rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  ASSERT_TRUE(first);
  rig.until_finished(*first);
  rig.run(0.25);  // of 0.4 s
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_GT(track.nearest(corner.at), 1e-4);
  EXPECT_LT(track.nearest(corner.at), 0.008);
  EXPECT_LT(track.hardest(rig.dt), 2.0 * 1.2 * 1.01);
  EXPECT_LT(pose_distance(rig.tcp(), corner.to), 1e-7);
}

TEST(ABlend, between_joint_motions_is_laid_in_joint_space)
{
  ArmRig rig;
  const Vector6 from = rig.state.target.position;
  const Vector6 at = from + six(0.6, 0.0, 0.0, 0.0, 0.0, 0.0), to = at + six(0.0, 0.3, -0.3, 0.0, 0.0, 0.0);
  const Vector6 waypoint = forward_tcp(rig.model, at, Vector6::Zero());
  const Track track = drive(rig, {[&] { return rig.arm.move_joint(at, {1.4, 1.05, 0.0, 0.1}); },
                                  [&] { return rig.arm.move_joint(to, {1.4, 1.05}); }});
  EXPECT_GT(track.nearest(waypoint), 0.005);
  EXPECT_LT(track.nearest(waypoint), 0.1);
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    if ((track.poses[i] - waypoint).head<3>().norm() > 0.105) {
      const double off_first = std::abs(track.joints[i][1] - from[1]);
      const double off_second = std::abs(track.joints[i][0] - at[0]);
      ASSERT_LT(std::min(off_first, off_second), 1e-9);
    }
    ASSERT_NEAR(track.joints[i][5], from[5], 1e-12) << "joints that do not move, move in no blend either";
  }
  EXPECT_LT(rig.hardest, 1.4 * 1.01) << "each joint moves in one of the two motions";
  EXPECT_GT(track.slowest_between(track.begun[1], track.begun[1] + 50), 0.1);
  EXPECT_EQ(rig.state.target.position, to);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
}

TEST(ABlend, joins_joint_motions_and_lines_in_either_order)
{
  for (const bool joint_first : {true, false}) {
    ArmRig rig;
    const Vector6 from = rig.state.target.position;
    Vector6 beside = from;
    beside[0] += 0.4;
    const Vector6 at =
        joint_first ? forward_tcp(rig.model, beside, Vector6::Zero()) : moved(rig.tcp(), 0.0, 0.15, 0.0);
    const auto joint = [&](const Vector6 & target, double r) {
      return [&, target, r] { return rig.arm.move_joint(target, {1.4, 1.05, 0.0, r}); };
    };
    const auto line = [&](const Vector6 & target, double r) {
      return [&, target, r] { return rig.arm.move_linear(target, {1.2, 0.25, 0.0, r}); };
    };
    const Vector6 above = moved(at, 0.0, 0.0, 0.2);
    const Track track = joint_first ? drive(rig, {joint(beside, 0.04), line(above, 0.0)})
                                    : drive(rig, {line(at, 0.04), joint(beside, 0.0)});
    EXPECT_LT(track.nearest(at), 0.04) << joint_first;
    EXPECT_GT(track.nearest(at), 1e-3) << joint_first;
    EXPECT_GT(track.slowest_between(track.begun[1], track.begun[1] + 50), 0.05) << joint_first;
    EXPECT_LT(rig.hardest, 40.0) << joint_first;
    if (joint_first) {
      EXPECT_LT(pose_distance(rig.tcp(), above), 1e-7);
    } else {
      EXPECT_EQ(rig.state.target.position, beside);
    }
    EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
  }
}

TEST(ABlend, turns_the_tool_without_a_leap)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector6 at = turned(moved(from, 0.0, 0.2, 0.0), Vector3(0.0, 0.0, 0.3));
  const Vector6 to = turned(moved(at, 0.0, 0.0, 0.2), Vector3(0.2, 0.0, -0.2));
  drive(rig, {[&] { return rig.arm.move_linear(at, {1.2, 0.25, 0.0, 0.05}); },
              [&] { return rig.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_LT(rig.hardest, 20.0);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(ABlend, that_would_overlap_with_the_one_before_leaves_its_waypoint_out)
{
  ArmRig rig;
  const Corner corner(rig);
  const Vector6 close = moved(corner.at, 0.03, 0.0, 0.0);
  bool is_skipped = false;
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
                                  [&] {
                                    const auto skipped = rig.arm.move_linear(close, {1.2, 0.25, 0.0, 0.02});
                                    is_skipped = skipped && *skipped == skipped_motion;
                                    return skipped;
                                  },
                                  [&] { return rig.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_TRUE(is_skipped);
  EXPECT_NEAR(track.nearest(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  EXPECT_LT(pose_distance(rig.tcp(), corner.to), 1e-7);
}

TEST(ABlend, as_wide_as_the_whole_way_from_a_standstill_leaves_the_waypoint_out)
{
  ArmRig rig;
  const auto motion = rig.arm.move_linear(moved(rig.tcp(), 0.0, 0.01, 0.0), {1.2, 0.25, 0.0, 0.02});
  ASSERT_TRUE(motion);
  EXPECT_EQ(*motion, skipped_motion);
  EXPECT_TRUE(rig.arm.finished(*motion));
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(ABlend, never_leaves_out_a_waypoint_to_stop_at)
{
  ArmRig rig;
  const Corner corner(rig);
  const Vector6 close = moved(corner.at, 0.0, 0.0, -0.02);
  drive(rig, {[&] { return rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
              [&] { return rig.arm.move_linear(close, {1.2, 0.25}); }});
  EXPECT_LT(pose_distance(rig.tcp(), close), 1e-7);
}

TEST(ABlend, takes_the_same_way_at_half_the_speed)
{
  ArmRig rig;
  const Corner corner(rig);
  rig.state.speed_slider = 0.5;
  rig.run(1.0);
  const Track track = drive(rig, {[&] { return rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05}); },
                                  [&] { return rig.arm.move_linear(corner.to, {1.2, 0.25}); }});
  EXPECT_NEAR(track.nearest(corner.at), 0.05 * std::sqrt(2.0) / 4.0, 5e-4);
  EXPECT_LT(track.fastest(), 0.1251);
}

TEST(ABlend, that_is_braked_stays_on_its_way)
{
  ArmRig rig, undisturbed;
  const Corner corner(rig);
  const MoveOptions through{1.2, 0.25, 0.0, 0.05};
  const Track way = drive(undisturbed, {[&] { return undisturbed.arm.move_linear(corner.at, through); },
                                        [&] { return undisturbed.arm.move_linear(corner.to, {1.2, 0.25}); }});
  const auto first = rig.arm.move_linear(corner.at, through);
  rig.until_finished(*first);
  const auto second = rig.arm.move_linear(corner.to, {1.2, 0.25});
  ASSERT_TRUE(second);
  rig.run(0.15);
  rig.arm.abandon(*second);
  rig.until_rest(0.5);
  EXPECT_LT(way.nearest(rig.tcp()), 3e-4);
  EXPECT_GT((rig.tcp() - corner.to).head<3>().norm(), 0.1);
}

TEST(ABlend, waits_when_the_program_pauses)
{
  ArmRig rig;
  const Corner corner(rig);
  const auto first = rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  rig.until_finished(*first);
  const auto second = rig.arm.move_linear(corner.to, {1.2, 0.25});
  rig.run(0.1);
  rig.arm.pause();
  rig.run(1.0);
  const Vector6 paused = rig.tcp();
  rig.run(0.5);
  EXPECT_LT(pose_distance(rig.tcp(), paused), 1e-9);
  rig.arm.resume();
  rig.until_finished(*second);
  EXPECT_LT(pose_distance(rig.tcp(), corner.to), 1e-7);
  EXPECT_LT(rig.hardest, 20.0);
}

TEST(ABlend, of_a_timed_motion_is_passed_in_the_middle_in_its_time)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  Vector6 at = from;
  testing::Starts starts;
  for (int i = 1; i <= 4; ++i) {
    at = moved(from, 0.0, 0.1 * i, 0.0);
    starts.push_back([&rig, at, i] { return rig.arm.move_linear(at, {1.2, 0.25, 0.5, i < 4 ? 0.02 : 0.0}); });
  }
  const Track track = drive(rig, starts);
  // The middle of the blend is where the tool passes the waypoint of a straight line.
  const auto passes = [&](double y) {
    std::size_t i = 0;
    while (i < track.poses.size() && track.poses[i][1] - from[1] < y) {
      ++i;
    }
    return static_cast<double>(i) * rig.dt;
  };
  EXPECT_NEAR(passes(0.1), 0.5, 0.01);
  EXPECT_NEAR(passes(0.2), 1.0, 0.01);
  EXPECT_NEAR(passes(0.3), 1.5, 0.01);
}

TEST(ABlend, does_not_join_motions_of_different_tools)
{
  ArmRig rig;
  const Corner corner(rig);
  const auto first = rig.arm.move_linear(corner.at, {1.2, 0.25, 0.0, 0.05});
  rig.until_finished(*first);
  rig.state.tcp_offset = six(0.0, 0.0, 0.1, 0.0, 0.0, 0.0);
  const Vector6 to =
      moved(forward_tcp(rig.model, rig.state.target.position, rig.state.tcp_offset), 0, 0, 0.1);
  drive(rig, {[&] { return rig.arm.move_linear(to, {1.2, 0.25}); }});
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
  EXPECT_LT(rig.hardest, 40.0);
}

}  // namespace
}  // namespace ur_simulator
