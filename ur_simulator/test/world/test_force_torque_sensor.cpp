#include <cmath>
#include <numbers>

#include "support/robot_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::RobotFixture;
using testing::six;

Payload load_of(double mass, const Vector3 & center = Vector3::Zero())
{
  Payload load;
  load.mass = mass;
  load.center_of_gravity = center;
  return load;
}

TEST(ForceTorqueSensorTest, ReadsZeroWithoutContact)
{
  RobotFixture fixture;
  fixture.run(0.1);
  EXPECT_LT(fixture.state.actual_tcp_force.norm(), 1e-9);
  EXPECT_LT(fixture.state.ft_raw_wrench.norm(), 1e-9);
}

TEST(ForceTorqueSensorTest, ReportsTheForceAtTheTcpInTheBaseFrame)
{
  RobotFixture fixture;
  fixture.state.tcp_offset = six(0.1, 0.0, 0.2, 0.0, 0.0, 0.5);
  fixture.run(0.1);
  fixture.world.push({six(0, 0, 40.0, 0, 0, 0), 10.0, false});
  fixture.run(5.0);  // the peak of the sine
  EXPECT_NEAR(fixture.state.actual_tcp_force[2], 40.0, 0.01);
  EXPECT_LT(fixture.state.actual_tcp_force.tail<3>().norm(), 0.01)
      << "a force at the TCP has no moment about it";
  EXPECT_NEAR(fixture.state.reported_tcp_force.tail<3>().norm(), 0.1 * 40.0, 0.01)
      << "an e-Series reports that about the flange";
  // The tool points down: up is -z of the flange, the lever arm is 0.1 m.
  EXPECT_NEAR(fixture.state.ft_raw_wrench[2], -40.0, 0.01);
  EXPECT_NEAR(fixture.state.ft_raw_wrench[4], 0.1 * 40.0, 0.01);
  fixture.state.external_sensor.enabled = true;
  fixture.state.external_force_torque = six(0, 0, -7.0, 0, 0, 0);
  fixture.run(1.0);
  EXPECT_NEAR((fixture.state.reported_tcp_force - fixture.state.actual_tcp_force).norm(), 0.0, 1e-9)
      << "unless an external sensor measures it";
}

TEST(ForceTorqueSensorTest, IsZeroedByTheStartOfAProgram)
{
  RobotFixture fixture;
  fixture.world.attach_load(load_of(2.0, Vector3(0.0, 0.0, 0.05)));
  fixture.run(0.1);
  EXPECT_LT(fixture.state.actual_tcp_force[2], -10.0);
  fixture.world.begin_program();
  fixture.run(0.1);
  EXPECT_LT(fixture.state.actual_tcp_force.norm(), 1e-3);
}

TEST(ForceTorqueSensorTest, ReportsTheWeightOfALoadThatIsNotInThePayload)
{
  RobotFixture fixture;
  fixture.world.attach_load(load_of(2.0, Vector3(0.0, 0.0, 0.05)));
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.actual_tcp_force[2], -2.0 * 9.82, 1e-3);
  fixture.state.payload = load_of(2.0, Vector3(0.0, 0.0, 0.05));
  fixture.run(0.1);
  EXPECT_LT(fixture.state.actual_tcp_force.norm(), 1e-3);
  fixture.state.payload = load_of(2.5, Vector3(0.0, 0.0, 0.05));
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.actual_tcp_force[2], 0.5 * 9.82, 1e-3);
}

TEST(ForceTorqueSensorTest, RawReadingIncludesTheWeightOfTheLoad)
{
  RobotFixture fixture;
  fixture.world.attach_load(load_of(2.0));
  fixture.state.payload = load_of(2.0);
  fixture.world.zero_sensor();
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.ft_raw_wrench[2], 2.0 * 9.82, 1e-3);  // in the flange frame: down is +z
}

TEST(ForceTorqueSensorTest, ZeroingHidesAWrongPayloadUntilTheToolRotates)
{
  RobotFixture fixture;
  fixture.world.attach_load(load_of(1.0));
  fixture.run(0.1);
  fixture.world.zero_sensor();
  fixture.run(0.1);
  EXPECT_LT(fixture.state.actual_tcp_force.norm(), 1e-3);
  Vector6 turned = fixture.state.actual.position;
  turned[3] += std::numbers::pi / 2.0;
  fixture.arm.teleport(turned, fixture.state);
  fixture.run(0.1);
  EXPECT_NEAR(fixture.state.actual_tcp_force.head<3>().norm(), std::sqrt(2.0) * 9.82, 0.01);
}

TEST(ForceTorqueSensorTest, CompensatesTheInertiaOfThePayload)
{
  RobotFixture fixture;
  fixture.world.attach_load(load_of(3.0));
  fixture.state.payload = load_of(3.0);
  fixture.run(0.1);
  ASSERT_TRUE(fixture.move_down(0.2, 0.5));
  double most = 0.0, raw = 0.0;
  for (int i = 0; i < 150; ++i) {
    fixture.step();
    most = std::max(most, fixture.state.actual_tcp_force.norm());
    raw = std::max(raw, std::abs(fixture.state.ft_raw_wrench[2] - 3.0 * 9.82));
  }
  EXPECT_LT(most, 1e-6);
  EXPECT_GT(raw, 3.0);
}

TEST(ForceTorqueSensorTest, NoiseHasTheGivenDeviationAndDependsOnTheSeed)
{
  const auto deviation = [](std::uint64_t seed, double & first) {
    ControllerState state;
    World world(testing::model_named("ur10e"), seed);
    world.set_sensor_noise(1.0, 0.1);
    double sum = 0.0;
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
      world.step(state);
      first = i == 0 ? state.ft_raw_wrench[0] : first;
      sum += state.ft_raw_wrench[0] * state.ft_raw_wrench[0];
    }
    return std::sqrt(sum / count);
  };
  double first = 0.0, again = 0.0, other = 0.0;
  EXPECT_NEAR(deviation(5, first), 1.0, 0.03);
  deviation(5, again);
  deviation(6, other);
  EXPECT_DOUBLE_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(ForceTorqueSensorTest, FiltersAForceStep)
{
  RobotFixture fixture;
  fixture.run(0.1);
  fixture.world.surfaces().add(fixture.table_below(-0.002, 20000.0));
  fixture.step();
  const double sudden = fixture.state.contact_wrench[2];
  EXPECT_LT(fixture.state.actual_tcp_force[2], 0.75 * sudden);
  fixture.run(0.016);
  EXPECT_GT(fixture.state.actual_tcp_force[2], 0.95 * sudden);
}

}  // namespace
}  // namespace ur_simulator
