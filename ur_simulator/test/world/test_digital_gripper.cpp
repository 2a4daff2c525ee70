#include <gtest/gtest.h>

#include "world/digital_gripper.hpp"

namespace ur_simulator {
namespace {

constexpr std::uint64_t first_tool_bit = std::uint64_t{1} << 16;
constexpr std::uint64_t second_tool_bit = std::uint64_t{1} << 17;

class DigitalGripperTest : public ::testing::Test {
 protected:
  void run(DigitalGripper & gripper, double duration)
  {
    for (double time = 0.0; time < duration; time += 0.002) {
      gripper.step(0.002, io);
    }
  }
  Io io = [] {
    Io powered;
    powered.tool_output_voltage = 24;
    return powered;
  }();
};

TEST_F(DigitalGripperTest, SpringOpensASingleActingGripper)
{
  DigitalGripper gripper(false);
  io.digital_outputs = first_tool_bit;
  run(gripper, 0.2);
  EXPECT_NEAR(gripper.width(), 20.0, 0.5);
  EXPECT_EQ(io.digital_inputs, 0U);
  io.digital_outputs = 0;
  run(gripper, 0.3);
  EXPECT_EQ(gripper.width(), DigitalGripper::stroke);
  EXPECT_EQ(io.digital_inputs, second_tool_bit);
}

TEST_F(DigitalGripperTest, DoubleActingGripperStaysWithoutASignal)
{
  DigitalGripper gripper(true);
  io.digital_outputs = first_tool_bit;
  run(gripper, 0.2);
  io.digital_outputs = 0;
  run(gripper, 1.0);
  EXPECT_NEAR(gripper.width(), 20.0, 0.5);
  io.digital_outputs = second_tool_bit;
  run(gripper, 0.3);
  EXPECT_EQ(gripper.width(), DigitalGripper::stroke);
}

TEST_F(DigitalGripperTest, ReportsAHeldObject)
{
  DigitalGripper gripper(true);
  gripper.set_object(15.0);
  io.digital_outputs = first_tool_bit;
  run(gripper, 1.0);
  EXPECT_EQ(gripper.width(), 15.0);
  EXPECT_EQ(io.digital_inputs, first_tool_bit);
  gripper.set_object(0.0);
  run(gripper, 1.0);
  EXPECT_EQ(gripper.width(), 0.0);
  EXPECT_EQ(io.digital_inputs, 0U);
}

TEST_F(DigitalGripperTest, NeedsSupplyVoltageAndAir)
{
  DigitalGripper gripper(true);
  io.digital_outputs = first_tool_bit;
  io.tool_output_voltage = 12;
  run(gripper, 1.0);
  EXPECT_EQ(gripper.width(), DigitalGripper::stroke);
  EXPECT_EQ(io.digital_inputs, 0U);
  io.tool_output_voltage = 24;
  gripper.set_air(false);
  run(gripper, 1.0);
  EXPECT_EQ(gripper.width(), DigitalGripper::stroke);
}

}  // namespace
}  // namespace ur_simulator
