#include <numbers>
#include <set>
#include <string>

#include "kinematics/forward_kinematics.hpp"
#include "safety/collision_monitor.hpp"
#include "support/arm_fixture.hpp"

namespace ur_simulator {
namespace {

using std::numbers::pi;
using testing::model_named;
using testing::six;

/// The arm of a model, moved from one joint position to another without dynamics.
struct MovedArm {
  explicit MovedArm(const RobotModel & arm_model) : model(arm_model), monitor(arm_model)
  {
    state.actual.position = default_position(model);
  }
  std::optional<Collision> at(const Vector6 & joints)
  {
    state.actual.position = joints;
    return monitor.check(world, state);
  }
  /// The first collision on the way to the joint position.
  std::optional<Collision> move_to(const Vector6 & joints)
  {
    constexpr int steps = 200;
    const Vector6 from = state.actual.position;
    for (int i = 1; i <= steps; ++i) {
      if (auto collision = at(from + static_cast<double>(i) / steps * (joints - from))) {
        return collision;
      }
    }
    return std::nullopt;
  }
  const RobotModel & model;
  World world{model, 1};
  ControllerState state;
  CollisionMonitor monitor;
};

std::string text_of(const std::optional<Collision> & collision)
{
  return collision ? collision->description : "none";
}

TEST(OverlapMonitorTest, ReportsTheBeginningOfAnOverlap)
{
  OverlapMonitor monitor;
  EXPECT_FALSE(monitor.collides(-0.1));
  EXPECT_TRUE(monitor.collides(0.001));
  EXPECT_FALSE(monitor.collides(0.004));
  EXPECT_FALSE(monitor.collides(-0.0005)) << "still touching";
  EXPECT_FALSE(monitor.collides(0.001));
  EXPECT_FALSE(monitor.collides(-0.002));
  EXPECT_TRUE(monitor.collides(0.001)) << "again, after they were apart";
  EXPECT_TRUE(monitor.collides(0.0065)) << "clearly deeper";
}

TEST(OverlapMonitorTest, ToleratesAnOverlapFromTheBeginningUntilTheBodiesAreApart)
{
  OverlapMonitor monitor;
  EXPECT_FALSE(monitor.collides(0.01));
  EXPECT_FALSE(monitor.collides(0.5));
  EXPECT_FALSE(monitor.collides(-0.01));
  EXPECT_TRUE(monitor.collides(0.001));
}

/// Positions that are common in programs and in the tests of this project.
TEST(SelfCollisionTest, CommonPositionsAreFree)
{
  for (const RobotModel & model : robot_models()) {
    for (const Vector6 & joints :
         {default_position(model), six(0.0), six(0, -pi / 2, 0, -pi / 2, 0, 0),
          six(0, -pi / 2, pi / 2, -pi / 2, -pi / 2, 0), six(0.5, -0.5, -1.2, -1.2, 1.57, 1.0),
          six(0, -1.57, 2.4, -0.8, 1.57, 0), six(0.1, -1.2, 1.3, -1.4, -1.5, 0.6),
          six(-1.6, -1.73, -2.2, -0.81, 1.6, 0.0)}) {
      MovedArm arm(model);
      EXPECT_FALSE(arm.move_to(joints)) << model.name << ": " << joints.transpose();
    }
  }
}

/// The tool points down, at heights and distances as in most cells: the elbow is above the line from shoulder
/// to wrist.
TEST(SelfCollisionTest, PositionsWithTheToolPointingDownAreFree)
{
  testing::RandomVectors random(3);
  for (const RobotModel & model : robot_models()) {
    for (int i = 0; i < 500; ++i) {
      const double lift = -1.5 + random.number(0.7);
      const double elbow = -1.4 + random.number(0.7);
      MovedArm arm(model);
      arm.at(default_position(model));
      const Vector6 joints =
          six(random.number(pi), lift, elbow, -pi / 2 - lift - elbow, pi / 2, random.number(pi));
      EXPECT_FALSE(arm.at(joints)) << model.name << ": " << joints.transpose();
    }
  }
}

TEST(SelfCollisionTest, FoldedForearmHitsTheShoulder)
{
  for (const RobotModel & model : robot_models()) {
    MovedArm arm(model);
    const auto collision = arm.move_to(six(0, -pi / 2, -pi, -pi / 2, pi / 2, 0));
    ASSERT_TRUE(collision) << model.name;
    EXPECT_NE(collision->description.find("collision of the arm with itself"), std::string::npos);
    EXPECT_EQ(collision->code.code, 157);
  }
}

TEST(SelfCollisionTest, ForearmAndWristCanHitTheBase)
{
  testing::RandomVectors random(4);
  std::set<std::string> found;
  for (int i = 0; i < 20000; ++i) {
    MovedArm arm(model_named("ur5e"));
    arm.at(default_position(arm.model));
    const std::string text = text_of(arm.at(random.six(pi)));
    if (text.find("touches the base") != std::string::npos) {
      found.insert(text.substr(0, text.find(" touches")));
    }
  }
  EXPECT_TRUE(found.contains("the forearm") && found.contains("the wrist 3"));
}

/// A position at which a UR5e reported C403A0: UR forum, "Error C403A0: Danger of clamping between the robot
/// lower arm and tool". 5 degrees of the wrist 2 change the distance by 9 mm.
TEST(SelfCollisionTest, FlangeNearTheForearmIsADangerOfClamping)
{
  const Vector6 reported = six(136.46, 4.19, 63.94, 98.65, -133.19, -10.6) * (pi / 180.0);
  const auto turned_by = [&](double degrees) {
    MovedArm arm(model_named("ur5e"));
    EXPECT_FALSE(arm.at(default_position(arm.model)));
    return arm.at(reported + degrees * pi / 180.0 * Vector6::Unit(4));
  };
  EXPECT_FALSE(turned_by(5.0));
  const auto collision = turned_by(-5.0);
  ASSERT_TRUE(collision);
  EXPECT_EQ(collision->code.code, 403);
  EXPECT_NE(collision->description.find("the distance must be 28 mm"), std::string::npos);
}

TEST(WorldCollisionTest, LinkHitsABox)
{
  MovedArm arm(model_named("ur10e"));
  Box box;
  const auto frames = link_frames(arm.model, default_position(arm.model));
  box.center = frames[1].translation() + Vector3(0.0, -0.5, 0.0);  // beside the elbow
  box.size = Vector3::Constant(0.3);
  arm.world.boxes().add(box);
  ASSERT_FALSE(arm.at(default_position(arm.model)));
  const Vector6 turn = Vector6::Unit(0);
  const auto collision = arm.move_to(default_position(arm.model) - 1.5 * turn);
  const auto other = arm.move_to(default_position(arm.model) + 1.5 * turn);
  ASSERT_TRUE(collision || other);
  EXPECT_NE(text_of(collision ? collision : other).find("touches box 1"), std::string::npos);
}

TEST(WorldCollisionTest, ElbowHitsASurface)
{
  MovedArm arm(model_named("ur5e"));
  Surface floor;
  floor.point.z() = -0.01;
  arm.world.surfaces().add(floor);
  ASSERT_FALSE(arm.at(default_position(arm.model)));
  EXPECT_TRUE(
      text_of(arm.move_to(six(0, 0.3, -1.5, -1.57, 1.57, 0))).starts_with("the upper arm touches surface 1"));
}

TEST(WorldCollisionTest, ToolAndWrist3TouchOnlyAtTheTcp)
{
  for (const RobotModel & model : robot_models()) {
    MovedArm arm(model);
    Surface table;
    table.point.z() =
        flange_pose(model, default_position(model)).translation().z() + 0.01;  // pressed by 10 mm
    arm.at(default_position(model) + Vector6(0.5 * Vector6::Unit(1)));
    arm.world.surfaces().add(table);
    Vector6 above = default_position(model);
    above[1] -= 0.3;
    arm.at(above);
    const auto collision = arm.move_to(default_position(model));
    EXPECT_FALSE(collision && collision->description.starts_with("the wrist"))
        << model.name << text_of(collision);
  }
}

TEST(WorldCollisionTest, ObjectsThatContainALinkFromTheBeginningAreTolerated)
{
  MovedArm arm(model_named("ur10e"));
  Surface above_the_base;
  above_the_base.point.z() = 0.3;  // through shoulder and upper arm
  arm.world.surfaces().add(above_the_base);
  EXPECT_FALSE(arm.at(default_position(arm.model)));
  EXPECT_FALSE(arm.move_to(default_position(arm.model) + Vector6(0.1 * Vector6::Unit(1))));
}

TEST(WorldCollisionTest, ResetToleratesTheNewOverlaps)
{
  MovedArm arm(model_named("ur5e"));
  Surface floor;
  arm.world.surfaces().add(floor);
  ASSERT_FALSE(arm.at(six(0, -pi / 2, 0, -pi / 2, 0, 0)));
  arm.monitor.reset();
  EXPECT_FALSE(arm.at(six(0, 0.5, 0, -pi / 2, 0, 0)));
}

}  // namespace
}  // namespace ur_simulator
