#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "port_map/port_map.hpp"
#include "port_map/port_range.hpp"

namespace ur_simulator {
namespace {

class PortMapTest : public ::testing::Test {
 protected:
  ControllerState state;
  PortMap ports{state, {5, 25, 1, 0}};

  /// As a client reads a signed value.
  int signed_at(unsigned address) const { return static_cast<std::int16_t>(*ports.read_register(address)); }
  std::vector<int> signed_six(unsigned first) const
  {
    std::vector<int> values;
    for (unsigned i = 0; i < 6; ++i) {
      values.push_back(signed_at(first + i));
    }
    return values;
  }
};

using Six = std::vector<int>;

TEST_F(PortMapTest, StandardWordHasBoxBitsThenToolBits)
{
  state.io.digital_inputs = 0x01 | 0x80 | 1U << 9U | 1U << 17U;
  EXPECT_EQ(ports.read_register(0), 0x281);
  EXPECT_EQ(ports.read_register(21), 0x2);
  EXPECT_EQ(ports.read_register(30), 0x2);
  EXPECT_EQ(ports.read_bit(0), true);
  EXPECT_EQ(ports.read_bit(1), false);
  EXPECT_EQ(ports.read_bit(9), true);
  EXPECT_EQ(ports.read_bit(129), true);
}

TEST_F(PortMapTest, WordsWriteTheOutputsOfTheirGroup)
{
  state.io.digital_outputs = 0xff00;
  ports.write_register(1, 0xffff);
  EXPECT_EQ(state.io.digital_outputs, 0x3ffffU);
  ports.write_register(1, 0x0101);
  EXPECT_EQ(state.io.digital_outputs, 0x1ff01U);
  EXPECT_EQ(ports.read_register(1), 0x101);
  ports.write_register(31, 0x0f);
  EXPECT_EQ(state.io.digital_outputs, 0x10f01U);
  ports.write_register(22, 0x2);
  EXPECT_EQ(state.io.digital_outputs, 0x20f01U);
}

TEST_F(PortMapTest, MasksSetAndClearOutputs)
{
  ports.write_register(2, 0x0203);
  EXPECT_EQ(state.io.digital_outputs, 0x20003U);
  ports.write_register(3, 0x0201);
  EXPECT_EQ(state.io.digital_outputs, 0x2U);
  ports.write_register(32, 0xff81);
  EXPECT_EQ(state.io.digital_outputs, 0x8102U);
  ports.write_register(33, 0x0080);
  EXPECT_EQ(state.io.digital_outputs, 0x0102U);
  for (const unsigned address : {2U, 3U, 32U, 33U}) {
    EXPECT_EQ(ports.read_register(address), 0);
  }
}

TEST_F(PortMapTest, BitsSetAndClearOutputs)
{
  ports.write_bit(16, true);
  ports.write_bit(25, true);
  ports.write_bit(31, true);  // undefined
  EXPECT_EQ(state.io.digital_outputs, 0x20001U);
  EXPECT_EQ(ports.read_bit(25), true);
  EXPECT_EQ(ports.read_bit(31), false);
  ports.write_bit(33, true);
  ports.write_bit(34, false);
  EXPECT_EQ(state.io.digital_outputs, 0x20003U);
  ports.write_bit(48, true);
  ports.write_bit(49, false);
  EXPECT_EQ(state.io.digital_outputs, 0x20002U);
  ports.write_bit(136, true);
  ports.write_bit(145, true);
  EXPECT_EQ(state.io.digital_outputs, 0x20302U);
  ports.write_bit(152, true);
  EXPECT_EQ(state.io.digital_outputs, 0x20202U);
}

TEST_F(PortMapTest, AnalogValuesAreFractionsOfTheRangeOfTheirDomain)
{
  state.io.analog_inputs = {0.012, 5.0};
  state.io.analog_io_types = 0b10;
  state.io.tool_analog_inputs = {10.0, 0.02};
  state.io.tool_analog_input_types = 0b01;
  EXPECT_EQ(ports.read_register(4), 32768);
  EXPECT_EQ(ports.read_register(5), 0);
  EXPECT_EQ(ports.read_register(6), 32768);
  EXPECT_EQ(ports.read_register(7), 1);
  EXPECT_EQ(ports.read_register(8), 65535);
  EXPECT_EQ(ports.read_register(10), 65535);
  ports.write_register(17, 1);
  ports.write_register(16, 65535);
  ports.write_register(18, 0);
  EXPECT_DOUBLE_EQ(state.io.analog_outputs[0], 10.0);
  EXPECT_DOUBLE_EQ(state.io.analog_outputs[1], 0.004);
  EXPECT_EQ(state.io.analog_io_types, 0b0110U);
  ports.write_register(7, 0);
  EXPECT_EQ(state.io.analog_io_types, 0b0100U);
}

TEST_F(PortMapTest, RejectsValuesThatASettingDoesNotHave)
{
  EXPECT_EQ(ports.check_register(5, 2), PortWrite::illegal_value);
  EXPECT_EQ(ports.check_register(20, 13), PortWrite::illegal_value);
  EXPECT_EQ(ports.check_register(20, 24), PortWrite::possible);
  ports.write_register(20, 24);
  ports.write_register(20, 13);
  EXPECT_EQ(state.io.tool_output_voltage, 24);
}

TEST_F(PortMapTest, JointAnglesAreCountedFromZeroInEachRevolution)
{
  constexpr double turn = 2.0 * std::numbers::pi;
  state.actual.position << 1.0, -1.0, turn + 0.5, -turn - 0.5, 0.0, -0.25;
  EXPECT_EQ(signed_six(270), (Six{1000, 5283, 500, 5783, 0, 6033}));
  EXPECT_EQ(signed_six(320), (Six{0, -1, 1, -2, 0, -1}));
  EXPECT_EQ(ports.read_register(321), 65535);
}

TEST_F(PortMapTest, JointValuesAreSigned)
{
  state.actual.velocity << 0.5, -0.5, 3.1416, 0.0, 40.0, -40.0;
  state.actual.current << 1.25, -1.25, 0.0, 0.0, 0.0, 0.0;
  state.joint_modes = {253, 255, 239, 253, 253, 253};
  EXPECT_EQ(signed_six(280), (Six{500, -500, 3142, 0, 32767, -32768}));
  EXPECT_EQ(signed_six(290), (Six{1250, -1250, 0, 0, 0, 0}));
  EXPECT_EQ(signed_six(300), (Six{28, 28, 28, 28, 28, 28}));
  EXPECT_EQ(signed_six(310), (Six{253, 255, 239, 253, 253, 253}));
}

TEST_F(PortMapTest, TcpHasTenthsOfMillimetersAndMilliradians)
{
  state.actual_tcp_pose << 0.5, -0.25, 0.12345, 1.5, -3.1, 0.0;
  state.actual_tcp_speed << 0.5, -0.25, 0.0, 0.1, 0.0, -0.2;
  state.tcp_offset << 0.0, 0.0, 0.12, 0.0, 1.57, 0.0;
  EXPECT_EQ(signed_six(400), (Six{5000, -2500, 1235, 1500, -3100, 0}));
  EXPECT_EQ(signed_six(410), (Six{500, -250, 0, 100, 0, -200}));
  EXPECT_EQ(signed_six(420), (Six{0, 0, 120, 0, 1570, 0}));
}

TEST_F(PortMapTest, ReportsVersionModesAndStops)
{
  EXPECT_EQ(ports.read_register(256), 5);
  EXPECT_EQ(ports.read_register(257), 25);
  state.robot_mode = RobotMode::running;
  state.robot_status_bits = 0b1;
  EXPECT_EQ(ports.read_register(258), 7);
  EXPECT_EQ(ports.read_register(260), 1);
  EXPECT_EQ(ports.read_register(450), 600);
  state.safety_mode = SafetyMode::protective_stop;
  state.safety_status_bits = 1U << 2U | 1U << 10U;
  state.freedrive = true;
  EXPECT_EQ(signed_six(260), (Six{1, 1, 0, 1, 0, 1}));
  EXPECT_EQ(ports.read_register(266), 3);
  state.safety_mode = SafetyMode::robot_emergency_stop;
  EXPECT_EQ(signed_six(260), (Six{1, 0, 1, 1, 0, 1}));
  EXPECT_EQ(ports.read_bit(262), true);
  EXPECT_EQ(ports.read_bit(264), false);
}

TEST_F(PortMapTest, KeepsGeneralPurposeRegisters)
{
  ports.write_register(128, 1);
  ports.write_register(255, 65535);
  EXPECT_EQ(ports.read_register(128), 1);
  EXPECT_EQ(ports.read_register(255), 65535);
  EXPECT_EQ(ports.read_register(200), 0);
}

TEST_F(PortMapTest, SharesBooleanRegistersWithRtde)
{
  ports.write_bit(300, true);
  ports.write_bit(427, true);
  EXPECT_TRUE(state.inputs.bits[0] && state.inputs.bits[127]);
  state.outputs.bits[5] = true;
  EXPECT_EQ(ports.read_bit(505), true);
  EXPECT_EQ(ports.check_bit(505, false), PortWrite::illegal_address);
}

TEST_F(PortMapTest, SplitTimeKeepsTheTimeOfItsLastWrite)
{
  state.timestamp = ((26.0 * 60.0 + 3.0) * 60.0) + 4.5;  // 1 day, 2:03:04.500
  EXPECT_EQ(ports.read_register(2050), 0);
  ports.write_register(2048, 1);
  state.timestamp += 10.0;
  EXPECT_EQ(ports.read_register(2049), 500);
  EXPECT_EQ(ports.read_register(2050), 4);
  EXPECT_EQ(ports.read_register(2051), 3);
  EXPECT_EQ(ports.read_register(2052), 2);
  EXPECT_EQ(ports.read_register(2053), 1);
}

TEST_F(PortMapTest, ReservedAddressesReadAsZeroAndAreNotWritten)
{
  for (const unsigned address : {12U, 23U, 24U, 127U, 259U, 276U, 500U, 1024U}) {
    EXPECT_EQ(ports.read_register(address), 0) << address;
    EXPECT_EQ(ports.check_register(address, 0), PortWrite::illegal_address) << address;
  }
  EXPECT_EQ(ports.read_register(2054), std::nullopt);
  EXPECT_EQ(ports.read_bit(628), std::nullopt);
  EXPECT_EQ(ports.check_register(2054, 0), PortWrite::illegal_address);
  EXPECT_EQ(ports.check_bit(628, false), PortWrite::illegal_address);
}

TEST_F(PortMapTest, StateIsReadOnly)
{
  for (const unsigned address : {0U, 4U, 21U, 30U, 256U, 258U, 270U, 400U, 2049U}) {
    EXPECT_EQ(ports.check_register(address, 0), PortWrite::illegal_address) << address;
  }
  EXPECT_EQ(ports.check_bit(0, true), PortWrite::illegal_address);
  EXPECT_EQ(ports.check_bit(260, true), PortWrite::illegal_address);
}

TEST(PortMapVersionTest, OlderVersionsHaveFewerPorts)
{
  ControllerState state;
  state.actual.position[1] = -1.0;
  state.inputs.bits[0] = true;
  const PortMap first(state, {3, 0, 0, 0});
  EXPECT_EQ(first.read_register(321), 0);
  EXPECT_EQ(first.read_bit(300), false);
  EXPECT_EQ(first.check_bit(300, true), PortWrite::illegal_address);
  const PortMap cb3(state, {3, 15, 8, 0});
  EXPECT_EQ(cb3.read_register(256), 3);
  EXPECT_EQ(cb3.read_register(257), 15);
  EXPECT_EQ(cb3.read_register(321), 65535);
  EXPECT_EQ(cb3.read_bit(300), true);
}

template <typename Range>
void expect_sorted_without_overlaps(std::span<const Range> ranges, unsigned count)
{
  unsigned end = 0;
  for (const Range & range : ranges) {
    EXPECT_GE(range.first, end);
    end = range.first + range.count;
  }
  EXPECT_LE(end, count);
}

TEST(PortRangeTest, AreSortedAndWithinTheMap)
{
  expect_sorted_without_overlaps(port_map::register_ranges(), PortMap::register_count);
  expect_sorted_without_overlaps(port_map::bit_ranges(), PortMap::bit_count);
}

}  // namespace
}  // namespace ur_simulator
