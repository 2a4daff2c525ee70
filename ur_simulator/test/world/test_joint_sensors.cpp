#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random_vectors.hpp"
#include "world/joint_sensors.hpp"

namespace ur_simulator {
namespace {

using testing::model_named;

constexpr int count = 20000;
constexpr double encoder_step = 2.0 * std::numbers::pi / (1 << 19);

struct Deviation {
  Vector6 position = Vector6::Zero();
  Vector6 current = Vector6::Zero();
  Vector3 acceleration = Vector3::Zero();
};

ControllerState powered_state()
{
  ControllerState state;
  state.robot_status_bits = 1;
  return state;
}

Deviation deviation_at_rest(const char * model)
{
  ControllerState state = powered_state();
  JointSensors sensors(model_named(model), 1);
  Deviation sum;
  for (int i = 0; i < count; ++i) {
    sensors.step(state);
    sum.position += state.measured.position.cwiseAbs2();
    sum.current += state.measured.current.cwiseAbs2();
    sum.acceleration += (state.measured.tool_acceleration - state.tool_acceleration).cwiseAbs2();
  }
  return {(sum.position / count).cwiseSqrt(), (sum.current / count).cwiseSqrt(),
          (sum.acceleration / count).cwiseSqrt()};
}

TEST(JointSensorsTest, ReadingsHaveTheNoiseOfRecordedRobots)
{
  const Deviation e_series = deviation_at_rest("ur5e");
  EXPECT_NEAR(e_series.position[0], 1.8e-5, 2e-6);
  EXPECT_NEAR(e_series.current[0], 0.027, 0.002);
  EXPECT_NEAR(e_series.current[5], 0.007, 0.001);
  EXPECT_NEAR(e_series.acceleration[2], 0.05, 0.003);
  const Deviation cb3 = deviation_at_rest("ur5");
  EXPECT_NEAR(cb3.current[0], 0.0165, 0.002);
  EXPECT_NEAR(cb3.current[5], 0.008, 0.001);
}

TEST(JointSensorsTest, PositionsAreStepsOfTheEncoder)
{
  ControllerState state = powered_state();
  state.actual.position = Vector6::Constant(1.0);
  JointSensors sensors(model_named("ur10e"), 1);
  sensors.step(state);
  for (const double position : state.measured.position) {
    EXPECT_NEAR(std::remainder(position, encoder_step), 0.0, 1e-12);
    EXPECT_NEAR(position, 1.0, 1e-4);
  }
}

TEST(JointSensorsTest, TcpPoseIsThatOfTheMeasuredPositions)
{
  ControllerState state = powered_state();
  state.actual.position = default_position(model_named("ur10e"));
  JointSensors sensors(model_named("ur10e"), 1);
  sensors.step(state);
  const Vector6 pose = state.measured.tcp_pose;
  sensors.step(state);
  EXPECT_NE(state.measured.tcp_pose, pose);
  EXPECT_LT((state.measured.tcp_pose - pose).head<3>().norm(), 2e-4);
}

TEST(JointSensorsTest, NoiseDependsOnTheSeedAlone)
{
  const auto first_reading = [](std::uint64_t seed) {
    ControllerState state = powered_state();
    JointSensors sensors(model_named("ur10e"), seed);
    sensors.step(state);
    return state.measured.current;
  };
  EXPECT_EQ(first_reading(5), first_reading(5));
  EXPECT_NE(first_reading(5), first_reading(6));
}

TEST(JointSensorsTest, AnArmWithoutPowerHasNoNoise)
{
  ControllerState state;
  JointSensors sensors(model_named("ur10e"), 1);
  sensors.step(state);
  EXPECT_EQ(state.measured.position, Vector6(Vector6::Zero()));
  EXPECT_EQ(state.measured.current, Vector6(Vector6::Zero()));
}

}  // namespace
}  // namespace ur_simulator
