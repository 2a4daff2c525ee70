#include "whole_rig.hpp"

namespace ur_simulator::testing {
namespace {

struct AToolContact : ::testing::Test {
  WholeRig rig;
  std::size_t steps(const Vector3 & direction, double threshold = 0.0) const
  {
    return rig.world.contact_steps(direction, threshold);
  }
  const Vector3 down{0.0, 0.0, -0.1};
};

TEST_F(AToolContact, is_not_found_in_free_space_with_a_noisy_sensor)
{
  rig.world.set_sensor_noise(0.5, 0.02);
  ASSERT_TRUE(rig.move_down(0.2, 0.2));
  for (int i = 0; i < 500; ++i) {
    rig.step();
    ASSERT_EQ(steps(down), 0u);
    ASSERT_EQ(steps(Vector3::Zero()), 0u);
  }
}

TEST_F(AToolContact, tells_when_the_tool_touched)
{
  rig.world.place_surface(rig.table_below(0.03, 20000.0));
  ASSERT_TRUE(rig.move_down(0.1, 0.05));
  std::size_t touched = 0;
  rig.until(
      [&] {
        touched += rig.state.contact_wrench[2] > 0.1 ? 1 : 0;
        return steps(down) > 0;
      },
      5.0);
  ASSERT_GT(touched, 0u);
  EXPECT_GE(steps(down) + 1, touched);
  EXPECT_LE(steps(down), touched + 6);
}

TEST_F(AToolContact, counts_only_what_opposes_the_direction)
{
  rig.world.place_surface(rig.table_below(0.005, 20000.0));
  ASSERT_TRUE(rig.move_down(0.007, 0.05));
  rig.run(1.0);
  EXPECT_GT(steps(down), 0u);
  EXPECT_GT(steps(Vector3::Zero()), 0u);
  EXPECT_EQ(steps(Vector3(0.0, 0.0, 1.0)), 0u);
  EXPECT_EQ(steps(Vector3(1.0, 0.0, 0.0)), 0u);
  EXPECT_EQ(steps(down, 100.0), 0u);
}

TEST_F(AToolContact, ends_when_the_tool_leaves)
{
  rig.world.place_surface(rig.table_below(0.005, 20000.0));
  ASSERT_TRUE(rig.move_down(0.007, 0.05));
  rig.run(1.0);
  ASSERT_GT(steps(down), 0u);
  ASSERT_TRUE(rig.move_down(-0.02, 0.05));
  rig.run(1.0);
  EXPECT_EQ(steps(down), 0u);
}

TEST_F(AToolContact, is_no_payload_that_is_set_and_no_zeroed_sensor)
{
  rig.world.attach_load({3.0, Vector3::Zero(), Vector6::Zero()});
  rig.state.payload.mass = 3.0;
  rig.run(0.5);
  rig.state.payload.mass = 0.0;
  rig.run(0.5);
  EXPECT_EQ(steps(Vector3::Zero()), 0u);
  rig.world.zero_sensor();
  rig.run(0.5);
  EXPECT_EQ(steps(Vector3::Zero()), 0u);
}

TEST(AnExternalSensor, takes_over_the_wrench)
{
  WholeRig rig;
  rig.state.external_sensor.enabled = true;
  rig.state.external_force_torque = six(0.0, 0.0, -12.0, 0.0, 0.0, 0.0);
  rig.run(1.0);
  const Vector3 z = to_rotation(rig.state.actual_tcp_pose.tail<3>()).col(2);
  EXPECT_LT((rig.state.actual_tcp_force.head<3>() - (-12.0 * z)).norm(), 1e-3);
  rig.state.external_sensor.enabled = false;
  rig.run(1.0);
  EXPECT_LT(rig.state.actual_tcp_force.norm(), 1e-3);
}

TEST(AnExternalSensor, has_the_payload_below_it_taken_out_of_its_reading)
{
  WholeRig rig;
  rig.state.external_sensor.enabled = true;
  rig.state.external_sensor.mass = 0.5;
  rig.state.payload.mass = 1.5;
  rig.run(1.0);
  // A sensor that reads nothing, though 1 kg should hang below it: something holds that up.
  EXPECT_NEAR(rig.state.actual_tcp_force[2], 9.82, 1e-2);
}

}  // namespace
}  // namespace ur_simulator::testing
