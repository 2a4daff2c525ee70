#include <cmath>
#include <numbers>

#include "whole_rig.hpp"

namespace ur_simulator {
namespace {

using testing::six;
using testing::WholeRig;

Payload load_of(double mass, const Vector3 & center = Vector3::Zero())
{
  Payload load;
  load.mass = mass;
  load.center_of_gravity = center;
  return load;
}

TEST(Sensor, reads_nothing_when_nothing_touches_the_tool)
{
  WholeRig rig;
  rig.run(0.1);
  EXPECT_LT(rig.state.actual_tcp_force.norm(), 1e-9);
  EXPECT_LT(rig.state.ft_raw_wrench.norm(), 1e-9);
}

TEST(Sensor, shows_the_force_on_the_tool_in_base_axes_at_the_tcp)
{
  WholeRig rig;
  rig.state.tcp_offset = six(0.1, 0.0, 0.2, 0.0, 0.0, 0.5);
  rig.run(0.1);
  rig.world.push({six(0, 0, 40.0, 0, 0, 0), 10.0, false});
  rig.run(5.0);  // the top of the sine: even for a while
  EXPECT_NEAR(rig.state.actual_tcp_force[2], 40.0, 0.01);
  EXPECT_LT(rig.state.actual_tcp_force.tail<3>().norm(), 0.01) << "a force at the TCP has no moment about it";
  // At the flange it has: the tool points down, so up is -z there, and the lever is 0.1 m.
  EXPECT_NEAR(rig.state.ft_raw_wrench[2], -40.0, 0.01);
  EXPECT_NEAR(rig.state.ft_raw_wrench[4], 0.1 * 40.0, 0.01);
}

TEST(Sensor, shows_the_weight_of_a_load_that_set_payload_did_not_name)
{
  WholeRig rig;
  rig.world.attach_load(load_of(2.0, Vector3(0.0, 0.0, 0.05)));
  rig.run(0.1);
  EXPECT_NEAR(rig.state.actual_tcp_force[2], -2.0 * 9.82, 1e-3);
  rig.state.payload = load_of(2.0, Vector3(0.0, 0.0, 0.05));
  rig.run(0.1);
  EXPECT_LT(rig.state.actual_tcp_force.norm(), 1e-3);
  rig.state.payload = load_of(2.5, Vector3(0.0, 0.0, 0.05));
  rig.run(0.1);
  EXPECT_NEAR(rig.state.actual_tcp_force[2], 0.5 * 9.82, 1e-3);
}

TEST(Sensor, keeps_the_weight_of_the_load_in_its_raw_reading)
{
  WholeRig rig;
  rig.world.attach_load(load_of(2.0));
  rig.state.payload = load_of(2.0);
  rig.world.zero_sensor();
  rig.run(0.1);
  EXPECT_NEAR(rig.state.ft_raw_wrench[2], 2.0 * 9.82, 1e-6);  // flange axes: down is +z
}

TEST(Sensor, zeroed_hides_a_wrong_payload_until_the_tool_is_turned)
{
  WholeRig rig;
  rig.world.attach_load(load_of(1.0));
  rig.run(0.1);
  rig.world.zero_sensor();
  rig.run(0.1);
  EXPECT_LT(rig.state.actual_tcp_force.norm(), 1e-3);
  Vector6 turned = rig.state.actual.position;
  turned[3] += std::numbers::pi / 2.0;
  rig.arm.teleport(turned, rig.state);
  rig.run(0.1);
  EXPECT_NEAR(rig.state.actual_tcp_force.head<3>().norm(), std::sqrt(2.0) * 9.82, 0.01);
}

TEST(Sensor, compensates_the_inertia_of_the_payload_it_was_told)
{
  WholeRig rig;
  rig.world.attach_load(load_of(3.0));
  rig.state.payload = load_of(3.0);
  rig.run(0.1);
  ASSERT_TRUE(rig.move_down(0.2, 0.5));
  double most = 0.0, raw = 0.0;
  for (int i = 0; i < 150; ++i) {
    rig.step();
    most = std::max(most, rig.state.actual_tcp_force.norm());
    raw = std::max(raw, std::abs(rig.state.ft_raw_wrench[2] - 3.0 * 9.82));
  }
  EXPECT_LT(most, 1e-6);
  EXPECT_GT(raw, 3.0);
}

TEST(Sensor, has_noise_of_the_size_it_is_told_and_the_same_for_the_same_seed)
{
  const auto deviation = [](std::uint64_t seed, double & first) {
    ControllerState state;
    World world(0.002, seed);
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

TEST(Sensor, smooths_a_sudden_force_within_some_cycles)
{
  WholeRig rig;
  rig.run(0.1);
  rig.world.place_surface(rig.table_below(-0.002, 20000.0));
  rig.step();
  const double sudden = rig.state.contact_wrench[2];
  EXPECT_LT(rig.state.actual_tcp_force[2], 0.75 * sudden);
  rig.run(0.016);
  EXPECT_GT(rig.state.actual_tcp_force[2], 0.95 * sudden);
}

}  // namespace
}  // namespace ur_simulator
