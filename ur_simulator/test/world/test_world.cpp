#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/robot_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::RobotFixture;
using testing::six;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Stiffness of a surface in series with the arm, N/m.
double felt_stiffness(const RobotFixture & fixture, const Surface & surface)
{
  const Vector3 normal = surface.normal.normalized();
  return 1.0 / (1.0 / surface.elasticity.stiffness + normal.dot(fixture.state.tcp_compliance * normal));
}

TEST(SurfaceTest, ForceIsStiffnessTimesPenetrationForAStiffArm)
{
  ControllerState state;  // no compliance
  World world(testing::model_named("ur10e"), 1);
  Surface table;
  table.point.z() = 0.001;
  world.surfaces().add(table);
  world.step(state);
  EXPECT_NEAR(state.contact_wrench[2], 20.0, 1e-9);
}

TEST(SurfaceTest, ActsInSeriesWithTheElasticityOfTheArm)
{
  RobotFixture fixture;
  const Surface table = fixture.table_below(-0.001, 20000.0);
  fixture.world.surfaces().add(table);
  fixture.step();
  EXPECT_NEAR(fixture.state.contact_wrench[2], 0.001 * felt_stiffness(fixture, table), 1e-6);
  EXPECT_GT(fixture.state.contact_wrench[2], 8.0);
  EXPECT_LT(fixture.state.contact_wrench[2], 18.0);
  EXPECT_NEAR(fixture.state.contact_wrench.head<2>().norm(), 0.0, 1e-9);
}

TEST(SurfaceTest, PushesAlongItsNormal)
{
  RobotFixture fixture;
  Surface wall;
  wall.normal = Vector3(2.0, 0.0, 2.0);  // not of unit length
  wall.point = fixture.state.actual_tcp_pose.head<3>() + 0.002 * wall.normal.normalized();
  wall.elasticity.stiffness = 10000.0;
  fixture.world.surfaces().add(wall);
  fixture.step();
  const double expected = 0.002 * felt_stiffness(fixture, wall);
  EXPECT_LT((fixture.state.contact_wrench.head<3>() - expected * wall.normal.normalized()).norm(), 1e-6);
}

TEST(SurfaceTest, NeverPullsTheTool)
{
  RobotFixture fixture;
  Surface table = fixture.table_below(-0.0005, 1000.0, 5000.0);
  fixture.world.surfaces().add(table);
  ASSERT_TRUE(fixture.move_down(-0.2, 0.3));
  for (int i = 0; i < 200; ++i) {
    fixture.step();
    ASSERT_GE(fixture.state.contact_wrench[2], 0.0);
  }
}

TEST(SurfaceTest, FrictionOpposesTheSlidingTool)
{
  RobotFixture fixture;
  Surface table = fixture.table_below(-0.001, 20000.0, 0.0);
  table.elasticity.friction = 0.3;
  fixture.world.surfaces().add(table);
  ASSERT_TRUE(fixture.arm.speed_linear(six(0.0, 0.05, 0, 0, 0, 0), 1.0, 0.0));
  fixture.run(0.5);
  const double pressing = 0.001 * felt_stiffness(fixture, table);
  EXPECT_NEAR(fixture.state.contact_wrench[2], pressing, 0.02);
  EXPECT_NEAR(fixture.state.contact_wrench[1], -0.3 * pressing, 0.02);
}

TEST(SurfaceTest, HasNoEffectAfterRemoval)
{
  RobotFixture fixture;
  const auto id = fixture.world.surfaces().add(fixture.table_below(-0.001, 20000.0));
  fixture.step();
  EXPECT_GT(fixture.state.contact_wrench[2], 5.0);
  EXPECT_TRUE(fixture.world.surfaces().remove(id));
  EXPECT_FALSE(fixture.world.surfaces().remove(id));
  fixture.step();
  EXPECT_DOUBLE_EQ(fixture.state.contact_wrench.norm(), 0.0);
}

TEST(PushTest, IsAHalfSineOverTime)
{
  RobotFixture fixture;
  fixture.world.push({six(30.0, 0, 0, 0, 0, 2.0), 0.3, false});
  double sum = 0.0, peak = 0.0;
  for (int i = 0; i < 200; ++i) {
    fixture.step();
    sum += fixture.state.contact_wrench[0] * fixture.dt;
    peak = std::max(peak, fixture.state.contact_wrench[0]);
  }
  EXPECT_NEAR(peak, 30.0, 0.01);
  EXPECT_NEAR(sum, 30.0 * 0.3 * 2.0 / M_PI, 0.01);
  EXPECT_FALSE(fixture.world.pushing());
  EXPECT_DOUBLE_EQ(fixture.state.contact_wrench.norm(), 0.0);
}

TEST(PushTest, InTheToolFrameRotatesWithTheTool)
{
  RobotFixture fixture;
  fixture.world.push({six(0, 0, 10.0, 0, 0, 0), 0.2, true});
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.contact_wrench[2], -10.0, 0.01);  // the tool points down
}

TEST(WorldTest, ErrorContainsFieldAndLimitOfInvalidInput)
{
  RobotFixture fixture;
  Surface bad;
  bad.point.x() = nan_value;
  EXPECT_THROW(fixture.world.surfaces().add(bad), std::invalid_argument);
  bad = Surface();
  bad.normal.setZero();
  EXPECT_THROW(fixture.world.surfaces().add(bad), std::invalid_argument);
  bad = Surface();
  bad.elasticity.stiffness = -1.0;
  try {
    fixture.world.surfaces().add(bad);
    FAIL() << "accepted";
  } catch (const std::invalid_argument & error) {
    EXPECT_STREQ(error.what(), "surface: stiffness (N/m) must be in [0, 10000000], is -1");
  }
  EXPECT_THROW(fixture.world.push({six(nan_value), 0.3, false}), std::invalid_argument);
  EXPECT_THROW(fixture.world.push({six(1.0), 0.0, false}), std::invalid_argument);
  EXPECT_THROW(fixture.world.set_sensor_noise(nan_value, 0.0), std::invalid_argument);
  Payload load;
  load.mass = -1.0;
  EXPECT_THROW(fixture.world.attach_load(load), std::invalid_argument);
  EXPECT_TRUE(fixture.world.surfaces().empty());
  EXPECT_FALSE(fixture.world.pushing());
}

TEST(WorldTest, LimitsTheNumberOfSurfacesAndPushes)
{
  RobotFixture fixture;
  for (std::size_t i = 0; i < ObjectList<Surface>::max_size; ++i) {
    fixture.world.surfaces().add({});
  }
  EXPECT_THROW(fixture.world.surfaces().add({}), std::invalid_argument);
  fixture.world.surfaces().clear();
  EXPECT_NO_THROW(fixture.world.surfaces().add({}));
  for (std::size_t i = 0; i < World::max_pushes; ++i) {
    fixture.world.push({});
  }
  EXPECT_THROW(fixture.world.push({}), std::invalid_argument);
}

/// Moves down at 0.1 m/s and calls stopj(5) a few cycles after the force exceeds 20 N, as over a network.
double peak_of_force_experiment(double stiffness)
{
  RobotFixture fixture;
  fixture.world.set_sensor_noise(0.5, 0.02);
  fixture.world.surfaces().add(fixture.table_below(0.1, stiffness));
  fixture.world.zero_sensor();
  EXPECT_TRUE(fixture.move_down(0.3, 0.1));
  fixture.until([&] { return fixture.state.actual_tcp_force[2] > 20.0; }, 5.0);
  fixture.run(3 * fixture.dt);
  EXPECT_TRUE(fixture.arm.stop_joint(5.0));
  double peak = 0.0;
  fixture.until(
      [&] {
        peak = std::max(peak, fixture.state.actual_tcp_force[2]);
        return fixture.arm.at_rest();
      },
      1.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal) << fixture.log();
  EXPECT_LT(fixture.state.timestamp, 2.0);
  std::printf("stiffness %.0f N/m: peak %.1f N, held %.1f N\n", stiffness, peak,
              fixture.state.contact_wrench[2]);
  return peak;
}

TEST(MoveDownUntilContactTest, StopsOnATableWithAPeakOfTensOfNewtons)
{
  const double soft = peak_of_force_experiment(20000.0);
  EXPECT_GT(soft, 25.0);
  EXPECT_LT(soft, 100.0);
  const double hard = peak_of_force_experiment(50000.0);
  EXPECT_GT(hard, soft);
  EXPECT_LT(hard, 150.0);
}

TEST(MoveDownUntilContactTest, IsDeterministic)
{
  EXPECT_DOUBLE_EQ(peak_of_force_experiment(20000.0), peak_of_force_experiment(20000.0));
}

}  // namespace
}  // namespace ur_simulator
