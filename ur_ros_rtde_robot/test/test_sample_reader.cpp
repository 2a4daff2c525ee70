#include <gtest/gtest.h>
#include <ur_rtde/robot_state.h>

#include <cmath>

#include "state/sample_reader.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST(SampleReaderTest, NumbersThatTheControllerDoesNotProvideAreNaN)
{
  const auto state = std::make_shared<ur_rtde::RobotState>(std::vector<std::string>{"timestamp"});
  const SampleReader reader(state, 0, true);
  Sample sample;
  reader.read(sample);
  for (const double value : {sample.actual_q[0], sample.payload, sample.analog_inputs[0],
                             sample.analog_inputs[1], sample.analog_outputs[0], sample.analog_outputs[1],
                             sample.actual_momentum, sample.actual_main_voltage, sample.actual_robot_voltage,
                             sample.actual_robot_current, sample.actual_execution_time}) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
  EXPECT_EQ(sample.controller_time, 0.0);
}

}  // namespace
}  // namespace ur_ros_rtde::test
