#include <cmath>
#include <numbers>

#include "path_track.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::ArmRig;
using testing::drive;
using testing::moved;
using testing::pose_distance;
using testing::six;
using testing::Starts;
using testing::Track;
using testing::turned;

double rotation_between(const Vector6 & a, const Vector6 & b)
{
  return to_rotation_vector(to_rotation(a.tail<3>()).transpose() * to_rotation(b.tail<3>())).norm();
}

TEST(MoveP, keeps_its_speed_round_corners_which_are_arcs)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const std::vector<Vector6> corners{moved(from, 0.0, 0.15, 0.0), moved(from, 0.0, 0.15, -0.15),
                                     moved(from, 0.0, 0.0, -0.15), from};
  Starts starts;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double radius = i + 1 < corners.size() ? 0.03 : 0.0;
    starts.push_back([&, i, radius] { return rig.arm.move_process(corners[i], {1.2, 0.25, 0.0, radius}); });
  }
  const Track track = drive(rig, starts);
  const std::size_t ramp = static_cast<std::size_t>(0.25 / 1.2 / rig.dt) + 2;
  EXPECT_GT(track.slowest_between(ramp, track.arrived - ramp - 2), 0.2485);
  EXPECT_LT(track.fastest(), 0.2502);
  // A right angle with 30 mm tangents: an arc of 30 mm about a centre 30 mm from both lines.
  const Vector3 centre = moved(corners[0], 0.0, -0.03, -0.03).head<3>();
  int on_arc = 0;
  for (const Vector6 & pose : track.poses) {
    const Vector3 spoke = pose.head<3>() - centre;
    if (spoke[1] > 1e-3 && spoke[2] > 1e-3) {
      EXPECT_NEAR(spoke.norm(), 0.03, 2e-4);
      ++on_arc;
    }
  }
  EXPECT_NEAR(on_arc * rig.dt, 0.5 * pi * 0.03 / 0.25, 0.02);
  EXPECT_LT(pose_distance(rig.tcp(), from), 1e-7);
  EXPECT_LT(rig.hardest, 40.0);
  EXPECT_TRUE(rig.state.target.velocity.isZero(0.0));
}

TEST(MoveP, turns_the_tool_through_its_corners_without_a_leap)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector6 at = turned(moved(from, 0.0, 0.2, 0.0), Vector3(0.0, 0.0, 0.4));
  const Vector6 to = turned(moved(at, 0.0, 0.0, 0.2), Vector3(0.3, 0.0, 0.0));
  drive(rig, {[&] { return rig.arm.move_process(at, {1.2, 0.2, 0.0, 0.05}); },
              [&] { return rig.arm.move_process(to, {1.2, 0.2}); }});
  EXPECT_LT(rig.hardest, 20.0);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(MoveP, that_turns_back_on_itself_slows_down_instead)
{
  ArmRig rig;
  const Vector6 from = rig.tcp(), at = moved(from, 0.0, 0.2, 0.0);
  const Track track = drive(rig, {[&] { return rig.arm.move_process(at, {1.2, 0.25, 0.0, 0.02}); },
                                  [&] { return rig.arm.move_process(from, {1.2, 0.25}); }});
  EXPECT_LT(track.nearest(at), 0.02);
  EXPECT_LT(track.hardest(rig.dt), 20.0) << "either half of the turn: 10 m/s^2 at most";
  EXPECT_LT(pose_distance(rig.tcp(), from), 1e-7);
}

TEST(MoveP, that_nothing_follows_stops_at_its_waypoint)
{
  ArmRig rig;
  const Vector6 to = moved(rig.tcp(), 0.0, 0.2, 0.0);
  const Track track = drive(rig, {[&] { return rig.arm.move_process(to, {1.2, 0.25, 0.0, 0.005}); }});
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
  EXPECT_LT(track.hardest(rig.dt), 10.0 * 1.02);
}

TEST(MoveP, joins_lines_joint_motions_and_circles_in_one_path)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector6 home = rig.state.target.position;
  const MoveOptions through{1.2, 0.2, 0.0, 0.02};
  const Vector6 a = moved(from, 0.0, 0.1, 0.0), b = moved(a, 0.0, 0.0, -0.1), c = moved(b, 0.0, -0.2, 0.0);
  const Track track = drive(
      rig, {[&] { return rig.arm.move_linear(a, through); }, [&] { return rig.arm.move_process(b, through); },
            [&] {
              return rig.arm.move_circular(moved(b, 0.0, -0.1, -0.1), c, CircleMode::unconstrained, through);
            },
            [&] { return rig.arm.move_joint(home, {1.4, 1.05}); }});
  for (const Vector6 & waypoint : {a, b, c}) {
    EXPECT_LT(track.nearest(waypoint), 0.02);
  }
  EXPECT_GT(track.nearest(a), 1e-3);
  EXPECT_LT(track.nearest(b), 1e-3) << "the line touches the circle";
  EXPECT_GT(track.nearest(c), 1e-3);
  EXPECT_EQ(rig.state.target.position, home);
  EXPECT_LT(rig.hardest, 40.0);
}

/// A half circle about 0.1 m in front of where the tool is.
struct HalfCircle {
  explicit HalfCircle(const ArmRig & rig)
      : from(rig.tcp()),
        via(moved(from, 0.0, 0.1, 0.1)),
        to(moved(from, 0.0, 0.2, 0.0)),
        centre(moved(from, 0.0, 0.1, 0.0).head<3>())
  {
  }
  Vector6 from, via, to;
  Vector3 centre;
};

TEST(MoveC, keeps_to_the_circle_through_its_points_at_its_speed)
{
  for (const char * name : {"ur10e", "ur5", "ur20"}) {
    ArmRig rig(name);
    const HalfCircle half(rig);
    const Track track = drive(
        rig,
        {[&] { return rig.arm.move_circular(half.via, half.to, CircleMode::unconstrained, {1.2, 0.2}); }});
    for (const Vector6 & pose : track.poses) {
      const Vector3 spoke = pose.head<3>() - half.centre;
      ASSERT_NEAR(spoke.norm(), 0.1, 1e-7) << name;
      ASSERT_NEAR(spoke[0], 0.0, 1e-7) << name;
      ASSERT_GT(spoke[2], -1e-7) << name;
      ASSERT_LT(rotation_between(pose, half.from), 1e-6) << name;
    }
    EXPECT_LT(track.nearest(half.via), 1e-3);
    const double time = static_cast<double>(track.arrived) * rig.dt;
    EXPECT_NEAR(time, pi * 0.1 / 0.2 + 0.2 / 1.2, 3.0 * rig.dt) << name;
    const std::size_t ramp = static_cast<std::size_t>(0.2 / 1.2 / rig.dt) + 2;
    EXPECT_GT(track.slowest_between(ramp, track.arrived - ramp - 2), 0.199) << name;
    EXPECT_LT(pose_distance(rig.tcp(), half.to), 1e-7) << name;
  }
}

TEST(MoveC, may_be_more_than_a_half_circle)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector3 centre = moved(from, 0.0, 0.0, -0.1).head<3>();
  const auto on_circle = [&](double angle) {
    Vector6 pose = from;
    pose.head<3>() = centre + 0.1 * Vector3(0.0, std::sin(angle), std::cos(angle));
    return pose;
  };
  const Track track = drive(rig, {[&] {
                              return rig.arm.move_circular(on_circle(2.0), on_circle(5.0),
                                                           CircleMode::unconstrained, {1.2, 0.2});
                            }});
  EXPECT_LT(track.nearest(on_circle(4.0)), 1e-3);
  EXPECT_GT(track.nearest(on_circle(5.6)), 0.04);
  EXPECT_LT(pose_distance(rig.tcp(), on_circle(5.0)), 1e-7);
}

TEST(MoveC, in_fixed_mode_keeps_the_tool_at_the_same_angle_to_the_circle)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector3 centre = moved(from, -0.1, 0.0, 0.0).head<3>();
  const auto on_circle = [&](double angle) {
    Vector6 pose = turned(from, Vector3(0.5, 0.2, 0.1));  // its rotation does not count
    pose.head<3>() = centre + 0.1 * Vector3(std::cos(angle), std::sin(angle), 0.0);
    return pose;
  };
  const Track track = drive(
      rig,
      {[&] { return rig.arm.move_circular(on_circle(0.6), on_circle(1.2), CircleMode::fixed, {1.2, 0.1}); }});
  const Vector3 in_tool_at_start = to_rotation(from.tail<3>()).transpose() * Vector3::UnitX();
  for (const Vector6 & pose : track.poses) {
    const Vector3 spoke = (pose.head<3>() - centre).normalized();
    ASSERT_LT((to_rotation(pose.tail<3>()).transpose() * spoke - in_tool_at_start).norm(), 1e-6);
  }
  EXPECT_LT((rig.tcp() - on_circle(1.2)).head<3>().norm(), 1e-7);
  EXPECT_NEAR(rotation_between(rig.tcp(), from), 1.2, 1e-6);
}

TEST(MoveC, in_unconstrained_mode_turns_the_tool_evenly_to_its_target)
{
  ArmRig rig;
  const HalfCircle half(rig);
  const Vector6 to = turned(half.to, Vector3(0.0, 0.0, 0.6));
  drive(rig, {[&] { return rig.arm.move_circular(half.via, to, CircleMode::unconstrained, {1.2, 0.2}); }});
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
  EXPECT_LT(rig.hardest, 20.0);
}

TEST(MoveC, is_refused_where_there_is_no_circle)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const auto refused = [&](const Vector6 & via, const Vector6 & to) {
    const auto motion = rig.arm.move_circular(via, to, CircleMode::unconstrained, {1.2, 0.2});
    return !motion && motion.error().find("must not lie on one line") != std::string::npos;
  };
  EXPECT_TRUE(refused(moved(from, 0.0, 0.1, 0.0), moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(refused(from, moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(refused(moved(from, 0.0, 0.1, 0.1), from));
  EXPECT_TRUE(refused(moved(from, 0.0, 0.2, 0.0), moved(from, 0.0, 0.2, 0.0)));
  EXPECT_TRUE(rig.arm.at_rest());
}

TEST(ServoC, from_a_standstill_goes_straight_to_its_target)
{
  ArmRig rig;
  const Vector6 from = rig.tcp(), to = moved(from, 0.0, 0.1, 0.1);
  const Track track = drive(rig, {[&] { return rig.arm.servo_circular(to, {1.2, 0.25}); }});
  EXPECT_LT(track.nearest(moved(from, 0.0, 0.05, 0.05)), 1e-3);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(ServoC, leaves_on_the_circle_that_its_velocity_touches)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  const Vector6 at = moved(from, 0.0, 0.15, 0.0), to = moved(at, 0.0, 0.1, 0.1);
  // With the velocity along y, the circle has its centre 0.1 m above where the servo begins.
  const auto first = rig.arm.servo_circular(at, {1.2, 0.2, 0.0, 0.02});
  ASSERT_TRUE(first);
  rig.until_finished(*first);
  const Vector3 begun = rig.tcp().head<3>();
  const Vector3 chord = to.head<3>() - begun;
  const double radius = 0.5 * chord.squaredNorm() / chord[2];
  const Vector3 centre = begun + Vector3(0.0, 0.0, radius);
  rig.forget_extremes();
  const Track track = drive(rig, {[&] { return rig.arm.servo_circular(to, {1.2, 0.2}); }});
  for (const Vector6 & pose : track.poses) {
    ASSERT_NEAR((pose.head<3>() - centre).norm(), radius, 1e-6);
  }
  EXPECT_LT(rig.hardest, 20.0);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
}

TEST(ServoC, asked_again_and_again_for_one_target_comes_to_rest_at_it)
{
  ArmRig rig;
  const Vector6 to = moved(rig.tcp(), 0.0, 0.15, 0.05);
  for (int call = 0; call < 20; ++call) {
    const auto motion = rig.arm.servo_circular(to, {1.2, 0.25, 0.0, 0.03});
    ASSERT_TRUE(motion);
    rig.until_finished(*motion, 5.0);
    rig.step();
  }
  rig.until_rest(1.0);
  EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7);
  EXPECT_LT(rig.hardest, 40.0);
}

TEST(ServoC, with_its_target_behind_it_stops_and_goes_back)
{
  ArmRig rig;
  const Vector6 from = rig.tcp();
  ASSERT_TRUE(rig.arm.servo_circular(moved(from, 0.0, 0.3, 0.0), {1.2, 0.2}));
  rig.run(0.6);
  const Track track = drive(rig, {[&] { return rig.arm.servo_circular(from, {1.2, 0.2}); }});
  EXPECT_LT(pose_distance(rig.tcp(), from), 1e-7);
  EXPECT_LT(track.nearest(from), 1e-6);
  EXPECT_LT(rig.hardest, 40.0);
}

TEST(OptimoveJ, reaches_the_fraction_of_the_joints_speed_that_it_is_told)
{
  for (const double fraction : {0.3, 1.0}) {
    ArmRig rig;
    const Vector6 to = rig.state.target.position + six(2.0, 0.3, 0.1, 0.0, 0.0, 0.5);
    drive(rig, {[&] { return rig.arm.move_joint_optimally(to, {fraction, fraction}); }});
    EXPECT_NEAR(rig.fastest[0], fraction * rig.model.velocity_max[0], 1e-3);
    EXPECT_LT(rig.hardest, fraction * rig.model.acceleration_max[0] * 1.001);
    EXPECT_EQ(rig.state.target.position, to);
  }
}

TEST(OptimoveL, is_as_fast_as_the_joints_permit_and_no_faster)
{
  for (const char * name : {"ur3e", "ur10e", "ur30"}) {
    ArmRig rig(name);
    const Vector6 to = turned(moved(rig.tcp(), 0.0, 0.2, -0.1), Vector3(0.0, 0.0, 0.5));
    drive(rig, {[&] { return rig.arm.move_linear_optimally(to, {1.0, 1.0}); }});
    EXPECT_LT(rig.fastest.cwiseQuotient(rig.model.velocity_max).maxCoeff(), 1.0) << name;
    EXPECT_LT(rig.hardest, rig.model.acceleration_max.maxCoeff()) << name;
    EXPECT_GT(rig.hardest, 0.3 * rig.model.acceleration_max.maxCoeff()) << name;
    EXPECT_LT(pose_distance(rig.tcp(), to), 1e-7) << name;
  }
}

TEST(Optimove, refuses_what_is_no_fraction)
{
  ArmRig rig;
  const Vector6 pose = rig.tcp(), joints = rig.state.target.position;
  EXPECT_FALSE(rig.arm.move_joint_optimally(joints, {1.5, 0.3}));
  EXPECT_FALSE(rig.arm.move_joint_optimally(joints, {0.3, 0.0}));
  EXPECT_FALSE(rig.arm.move_linear_optimally(pose, {0.3, -0.1}));
  EXPECT_EQ(rig.arm.move_linear_optimally(pose, {2.0, 0.3}).error(), "optimovel: a must be in (0, 1], is 2");
}

TEST(APath, refuses_bad_targets_and_options)
{
  ArmRig rig;
  const Vector6 pose = moved(rig.tcp(), 0.0, 0.1, 0.0);
  Vector6 no_number = pose;
  no_number[1] = std::nan("");
  const Vector6 far = moved(pose, 5.0, 0.0, 0.0);
  using Start = MotionStart (Arm::*)(const Vector6 &, const MoveOptions &);
  for (const Start start :
       {Start(&Arm::move_process), Start(&Arm::servo_circular), Start(&Arm::move_linear)}) {
    EXPECT_FALSE((rig.arm.*start)(no_number, {1.2, 0.25}));
    EXPECT_FALSE((rig.arm.*start)(far, {1.2, 0.25}));
    EXPECT_FALSE((rig.arm.*start)(pose, {1.2, 0.0}));
    EXPECT_FALSE((rig.arm.*start)(pose, {0.0, 0.25}));
    EXPECT_FALSE((rig.arm.*start)(pose, {1.2, 0.25, 0.0, -0.01}));
    EXPECT_FALSE((rig.arm.*start)(pose, {1.2, 0.25, 0.0, std::nan("")}));
  }
  EXPECT_FALSE(rig.arm.move_circular(no_number, pose, CircleMode::unconstrained, {1.2, 0.25}));
  EXPECT_FALSE(
      rig.arm.move_circular(moved(pose, 0.0, 0.0, 0.1), far, CircleMode::unconstrained, {1.2, 0.25}));
  EXPECT_TRUE(rig.arm.at_rest());
}

}  // namespace
}  // namespace ur_simulator
