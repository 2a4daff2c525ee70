#include <cmath>
#include <limits>
#include <stdexcept>

#include "whole_rig.hpp"

namespace ur_simulator {
namespace {

using testing::six;
using testing::WholeRig;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Of a surface in series with the arm.
double felt_stiffness(const WholeRig & rig, const Surface & surface)
{
  const Vector3 normal = surface.normal.normalized();
  return 1.0 / (1.0 / surface.stiffness + normal.dot(rig.state.tcp_compliance * normal));
}

TEST(Surface, pushes_a_stiff_arm_back_by_its_stiffness_times_the_depth)
{
  ControllerState state;  // no compliance
  World world(0.002, 1);
  Surface table;
  table.point.z() = 0.001;
  world.place_surface(table);
  world.step(state);
  EXPECT_NEAR(state.contact_wrench[2], 20.0, 1e-9);
}

TEST(Surface, is_felt_through_the_elasticity_of_the_arm)
{
  WholeRig rig;
  const Surface table = rig.table_below(-0.001, 20000.0);
  rig.world.place_surface(table);
  rig.step();
  EXPECT_NEAR(rig.state.contact_wrench[2], 0.001 * felt_stiffness(rig, table), 1e-6);
  EXPECT_GT(rig.state.contact_wrench[2], 8.0);
  EXPECT_LT(rig.state.contact_wrench[2], 18.0);
  EXPECT_NEAR(rig.state.contact_wrench.head<2>().norm(), 0.0, 1e-9);
}

TEST(Surface, of_any_direction_pushes_along_its_normal)
{
  WholeRig rig;
  Surface wall;
  wall.normal = Vector3(2.0, 0.0, 2.0);  // not of unit length
  wall.point = rig.state.actual_tcp_pose.head<3>() + 0.002 * wall.normal.normalized();
  wall.stiffness = 10000.0;
  rig.world.place_surface(wall);
  rig.step();
  const double expected = 0.002 * felt_stiffness(rig, wall);
  EXPECT_LT((rig.state.contact_wrench.head<3>() - expected * wall.normal.normalized()).norm(), 1e-6);
}

TEST(Surface, never_pulls_the_tool_back_however_fast_it_leaves)
{
  WholeRig rig;
  Surface table = rig.table_below(-0.0005, 1000.0, 5000.0);
  rig.world.place_surface(table);
  ASSERT_TRUE(rig.move_down(-0.2, 0.3));
  for (int i = 0; i < 200; ++i) {
    rig.step();
    ASSERT_GE(rig.state.contact_wrench[2], 0.0);
  }
}

TEST(Surface, brakes_a_sliding_tool_by_friction_against_its_motion)
{
  WholeRig rig;
  Surface table = rig.table_below(-0.001, 20000.0, 0.0);
  table.friction = 0.3;
  rig.world.place_surface(table);
  ASSERT_TRUE(rig.arm.speed_linear(six(0.0, 0.05, 0, 0, 0, 0), 1.0, 0.0));
  rig.run(0.5);
  const double pressing = 0.001 * felt_stiffness(rig, table);
  EXPECT_NEAR(rig.state.contact_wrench[2], pressing, 0.02);
  EXPECT_NEAR(rig.state.contact_wrench[1], -0.3 * pressing, 0.02);
}

TEST(Surface, is_gone_when_removed)
{
  WholeRig rig;
  const auto id = rig.world.place_surface(rig.table_below(-0.001, 20000.0));
  rig.step();
  EXPECT_GT(rig.state.contact_wrench[2], 5.0);
  EXPECT_TRUE(rig.world.remove_surface(id));
  EXPECT_FALSE(rig.world.remove_surface(id));
  rig.step();
  EXPECT_DOUBLE_EQ(rig.state.contact_wrench.norm(), 0.0);
}

TEST(Push, is_half_a_sine_in_time_with_its_peak_in_the_middle)
{
  WholeRig rig;
  rig.world.push({six(30.0, 0, 0, 0, 0, 2.0), 0.3, false});
  double sum = 0.0, peak = 0.0;
  for (int i = 0; i < 200; ++i) {
    rig.step();
    sum += rig.state.contact_wrench[0] * rig.dt;
    peak = std::max(peak, rig.state.contact_wrench[0]);
  }
  EXPECT_NEAR(peak, 30.0, 0.01);
  EXPECT_NEAR(sum, 30.0 * 0.3 * 2.0 / M_PI, 0.01);
  EXPECT_FALSE(rig.world.pushing());
  EXPECT_DOUBLE_EQ(rig.state.contact_wrench.norm(), 0.0);
}

TEST(Push, in_the_tool_frame_turns_with_the_tool)
{
  WholeRig rig;
  rig.world.push({six(0, 0, 10.0, 0, 0, 0), 0.2, true});
  rig.run(0.1);
  EXPECT_NEAR(rig.state.contact_wrench[2], -10.0, 0.01);  // the tool points down
}

TEST(World, refuses_what_is_not_finite_or_out_of_range_by_field_and_limit)
{
  WholeRig rig;
  Surface bad;
  bad.point.x() = nan_value;
  EXPECT_THROW(rig.world.place_surface(bad), std::invalid_argument);
  bad = Surface();
  bad.normal.setZero();
  EXPECT_THROW(rig.world.place_surface(bad), std::invalid_argument);
  bad = Surface();
  bad.stiffness = -1.0;
  try {
    rig.world.place_surface(bad);
    FAIL() << "accepted";
  } catch (const std::invalid_argument & error) {
    EXPECT_STREQ(error.what(), "surface: stiffness (N/m) must be in [0, 10000000], is -1");
  }
  EXPECT_THROW(rig.world.push({six(nan_value), 0.3, false}), std::invalid_argument);
  EXPECT_THROW(rig.world.push({six(1.0), 0.0, false}), std::invalid_argument);
  EXPECT_THROW(rig.world.set_sensor_noise(nan_value, 0.0), std::invalid_argument);
  Payload load;
  load.mass = -1.0;
  EXPECT_THROW(rig.world.attach_load(load), std::invalid_argument);
  EXPECT_TRUE(rig.world.surfaces().empty());
  EXPECT_FALSE(rig.world.pushing());
}

TEST(World, holds_a_bounded_number_of_surfaces_and_pushes)
{
  WholeRig rig;
  for (std::size_t i = 0; i < World::max_surfaces; ++i) {
    rig.world.place_surface({});
  }
  EXPECT_THROW(rig.world.place_surface({}), std::invalid_argument);
  rig.world.clear_surfaces();
  EXPECT_NO_THROW(rig.world.place_surface({}));
  for (std::size_t i = 0; i < World::max_pushes; ++i) {
    rig.world.push({});
  }
  EXPECT_THROW(rig.world.push({}), std::invalid_argument);
}

/// The force experiment: down at 0.1 m/s, stopj(5) when the reading passes 20 N a few cycles late, as over a
/// network.
double peak_of_force_experiment(double stiffness)
{
  WholeRig rig;
  rig.world.set_sensor_noise(0.5, 0.02);
  rig.world.place_surface(rig.table_below(0.1, stiffness));
  rig.world.zero_sensor();
  EXPECT_TRUE(rig.move_down(0.3, 0.1));
  rig.until([&] { return rig.state.actual_tcp_force[2] > 20.0; }, 5.0);
  rig.run(3 * rig.dt);
  EXPECT_TRUE(rig.arm.stop_joint(5.0));
  double peak = 0.0;
  rig.until(
      [&] {
        peak = std::max(peak, rig.state.actual_tcp_force[2]);
        return rig.arm.at_rest();
      },
      1.0);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal) << rig.log();
  EXPECT_LT(rig.state.timestamp, 2.0);
  std::printf("stiffness %.0f N/m: peak %.1f N, held %.1f N\n", stiffness, peak, rig.state.contact_wrench[2]);
  return peak;
}

TEST(ForceExperiment, stops_on_a_table_with_a_peak_of_tens_of_newtons)
{
  const double soft = peak_of_force_experiment(20000.0);
  EXPECT_GT(soft, 25.0);
  EXPECT_LT(soft, 100.0);
  const double hard = peak_of_force_experiment(50000.0);
  EXPECT_GT(hard, soft);
  EXPECT_LT(hard, 150.0);
}

TEST(ForceExperiment, runs_the_same_way_every_time)
{
  EXPECT_DOUBLE_EQ(peak_of_force_experiment(20000.0), peak_of_force_experiment(20000.0));
}

}  // namespace
}  // namespace ur_simulator
