#include "support/robot_fixture.hpp"

namespace ur_simulator::testing {
namespace {

struct ToolContactTest : ::testing::Test {
  RobotFixture fixture;
  std::size_t steps(const Vector3 & direction, double threshold = 0.0) const
  {
    return fixture.world.cycles_since_contact(direction, threshold);
  }
  const Vector3 down{0.0, 0.0, -0.1};
};

TEST_F(ToolContactTest, IsNotDetectedInFreeSpaceWithANoisySensor)
{
  fixture.world.set_sensor_noise(0.5, 0.02);
  ASSERT_TRUE(fixture.move_down(0.2, 0.2));
  for (int i = 0; i < 500; ++i) {
    fixture.step();
    ASSERT_EQ(steps(down), 0u);
    ASSERT_EQ(steps(Vector3::Zero()), 0u);
  }
}

TEST_F(ToolContactTest, ReportsTheCycleOfTheContact)
{
  fixture.world.surfaces().add(fixture.table_below(0.03, 20000.0));
  ASSERT_TRUE(fixture.move_down(0.1, 0.05));
  std::size_t touched = 0;
  fixture.until(
      [&] {
        touched += fixture.state.contact_wrench[2] > 0.1 ? 1 : 0;
        return steps(down) > 0;
      },
      5.0);
  ASSERT_GT(touched, 0u);
  EXPECT_GE(steps(down) + 1, touched);
  EXPECT_LE(steps(down), touched + 6);
}

TEST_F(ToolContactTest, OnlyForcesAgainstTheDirectionCount)
{
  fixture.world.surfaces().add(fixture.table_below(0.005, 20000.0));
  ASSERT_TRUE(fixture.move_down(0.007, 0.05));
  fixture.run(1.0);
  EXPECT_GT(steps(down), 0u);
  EXPECT_GT(steps(Vector3::Zero()), 0u);
  EXPECT_EQ(steps(Vector3(0.0, 0.0, 1.0)), 0u);
  EXPECT_EQ(steps(Vector3(1.0, 0.0, 0.0)), 0u);
  EXPECT_EQ(steps(down, 100.0), 0u);
}

TEST_F(ToolContactTest, EndsWhenTheToolRetracts)
{
  fixture.world.surfaces().add(fixture.table_below(0.005, 20000.0));
  ASSERT_TRUE(fixture.move_down(0.007, 0.05));
  fixture.run(1.0);
  ASSERT_GT(steps(down), 0u);
  ASSERT_TRUE(fixture.move_down(-0.02, 0.05));
  fixture.run(1.0);
  EXPECT_EQ(steps(down), 0u);
}

TEST_F(ToolContactTest, IsNotTriggeredByAPayloadChangeOrZeroing)
{
  fixture.world.attach_load({3.0, Vector3::Zero(), Vector6::Zero()});
  fixture.state.payload.mass = 3.0;
  fixture.run(0.5);
  fixture.state.payload.mass = 0.0;
  fixture.run(0.5);
  EXPECT_EQ(steps(Vector3::Zero()), 0u);
  fixture.world.zero_sensor();
  fixture.run(0.5);
  EXPECT_EQ(steps(Vector3::Zero()), 0u);
}

TEST(ExternalSensorTest, ReplacesTheWrenchOfTheFlangeSensor)
{
  RobotFixture fixture;
  fixture.state.external_sensor.enabled = true;
  fixture.state.external_force_torque = six(0.0, 0.0, -12.0, 0.0, 0.0, 0.0);
  fixture.run(1.0);
  const Vector3 z = to_rotation_matrix(fixture.state.actual_tcp_pose.tail<3>()).col(2);
  EXPECT_LT((fixture.state.actual_tcp_force.head<3>() - (-12.0 * z)).norm(), 1e-3);
  fixture.state.external_sensor.enabled = false;
  fixture.run(1.0);
  EXPECT_LT(fixture.state.actual_tcp_force.norm(), 1e-3);
}

TEST(ExternalSensorTest, ReadingIsCompensatedForThePayload)
{
  RobotFixture fixture;
  fixture.state.external_sensor.enabled = true;
  fixture.state.external_sensor.mass = 0.5;
  fixture.state.payload.mass = 1.5;
  fixture.run(1.0);
  // An external sensor that reads zero although the payload is 1 kg: the load is supported.
  EXPECT_NEAR(fixture.state.actual_tcp_force[2], 9.82, 1e-2);
}

}  // namespace
}  // namespace ur_simulator::testing
