#include <gtest/gtest.h>

#include "modbus/description.hpp"
#include "modbus/protocol.hpp"
#include "support/bytes.hpp"

namespace ur_simulator::modbus {
namespace {

using testing::bytes;

class ModbusProtocolTest : public ::testing::Test {
 protected:
  ControllerState state;
  PortMap ports{state, {5, 25, 1, 0}};

  std::string answer(std::initializer_list<int> request) { return execute(ports, bytes(request)); }
};

TEST_F(ModbusProtocolTest, ReadsRegisters)
{
  state.ports.general_purpose[0] = 0x1234;
  state.ports.general_purpose[1] = 0xffff;
  EXPECT_EQ(answer({3, 0, 128, 0, 2}), bytes({3, 4, 0x12, 0x34, 0xff, 0xff}));
  EXPECT_EQ(answer({4, 0, 128, 0, 2}), bytes({4, 4, 0x12, 0x34, 0xff, 0xff}));
  EXPECT_EQ(answer({3, 0, 128, 0, 125}).size(), 252U);
}

TEST_F(ModbusProtocolTest, ReadsBitsFromTheLowestOn)
{
  state.inputs.bits[0] = state.inputs.bits[9] = true;
  EXPECT_EQ(answer({1, 1, 0x2c, 0, 10}), bytes({1, 2, 0x01, 0x02}));
  EXPECT_EQ(answer({2, 1, 0x2c, 0, 1}), bytes({2, 1, 0x01}));
  EXPECT_EQ(answer({2, 0, 0, 2, 0x74}).size(), 2U + 79U);
}

TEST_F(ModbusProtocolTest, WritesOneValue)
{
  EXPECT_EQ(answer({6, 0, 128, 0x12, 0x34}), bytes({6, 0, 128, 0x12, 0x34}));
  EXPECT_EQ(state.ports.general_purpose[0], 0x1234);
  EXPECT_EQ(answer({5, 0, 16, 0xff, 0}), bytes({5, 0, 16, 0xff, 0}));
  EXPECT_EQ(state.io.digital_outputs, 1U);
  EXPECT_EQ(answer({5, 0, 16, 0, 0}), bytes({5, 0, 16, 0, 0}));
  EXPECT_EQ(state.io.digital_outputs, 0U);
}

TEST_F(ModbusProtocolTest, WritesSeveralValues)
{
  EXPECT_EQ(answer({16, 0, 129, 0, 2, 4, 0, 7, 1, 0}), bytes({16, 0, 129, 0, 2}));
  EXPECT_EQ(state.ports.general_purpose[1], 7);
  EXPECT_EQ(state.ports.general_purpose[2], 256);
  EXPECT_EQ(answer({15, 0, 16, 0, 10, 2, 0x81, 0x02}), bytes({15, 0, 16, 0, 10}));
  EXPECT_EQ(state.io.digital_outputs, 0x20081U);
}

TEST_F(ModbusProtocolTest, RejectsUnknownFunctions)
{
  EXPECT_EQ(answer({43, 14, 1, 0}), bytes({0xab, 1}));
  EXPECT_EQ(answer({0}), bytes({0x80, 1}));
  EXPECT_EQ(answer({0x83, 0, 0, 0, 1}), bytes({0x83, 1}));
}

TEST_F(ModbusProtocolTest, RejectsAddressesOutsideTheMap)
{
  EXPECT_EQ(answer({3, 8, 5, 0, 1}), bytes({3, 2, 0, 0}));
  EXPECT_EQ(answer({3, 8, 5, 0, 2}), bytes({0x83, 2}));
  EXPECT_EQ(answer({4, 0xff, 0xff, 0, 125}), bytes({0x84, 2}));
  EXPECT_EQ(answer({1, 2, 0x74, 0, 1}), bytes({0x81, 2}));
  EXPECT_EQ(answer({6, 0, 0, 0, 1}), bytes({0x86, 2}));
  EXPECT_EQ(answer({5, 0, 0, 0xff, 0}), bytes({0x85, 2}));
}

TEST_F(ModbusProtocolTest, RejectsInvalidQuantitiesAndValues)
{
  EXPECT_EQ(answer({3, 0, 128, 0, 0}), bytes({0x83, 3}));
  EXPECT_EQ(answer({3, 0, 128, 0, 126}), bytes({0x83, 3}));
  EXPECT_EQ(answer({1, 0, 0, 7, 0xd1}), bytes({0x81, 3}));
  EXPECT_EQ(answer({5, 0, 16, 0, 1}), bytes({0x85, 3}));
  EXPECT_EQ(answer({6, 0, 20, 0, 13}), bytes({0x86, 3}));
  EXPECT_EQ(answer({16, 0, 128, 0, 124, 248}), bytes({0x90, 3}));
}

TEST_F(ModbusProtocolTest, RejectsRequestsOfTheWrongLength)
{
  for (const int function : {1, 2, 3, 4, 5, 6, 15, 16}) {
    const int rejected = function | 0x80;
    EXPECT_EQ(answer({function}), bytes({rejected, 3}));
    EXPECT_EQ(answer({function, 0, 128, 0}), bytes({rejected, 3}));
    EXPECT_EQ(answer({function, 0, 128, 0, 0, 0}), bytes({rejected, 3}));
  }
  EXPECT_EQ(answer({16, 0, 128, 0, 2, 4, 0, 1, 0}), bytes({0x90, 3}));
  EXPECT_EQ(answer({16, 0, 128, 0, 2, 3, 0, 1, 0, 2}), bytes({0x90, 3}));
  EXPECT_EQ(answer({15, 0, 16, 0, 9, 1, 0xff}), bytes({0x8f, 3}));
}

TEST_F(ModbusProtocolTest, WritesAllValuesOrNone)
{
  EXPECT_EQ(answer({16, 0, 254, 0, 3, 6, 0, 1, 0, 2, 0, 3}), bytes({0x90, 2}));
  EXPECT_EQ(state.ports.general_purpose[126], 0);
  EXPECT_EQ(answer({16, 0, 16, 0, 2, 4, 0xff, 0xff, 0, 2}), bytes({0x90, 3}));
  EXPECT_EQ(state.io.analog_outputs[0], 0.0);
}

TEST(ModbusDescriptionTest, NamesFunctionAndAddresses)
{
  EXPECT_EQ(describe_request(bytes({3, 1, 0x90, 0, 6})), "read holding registers 400 to 405");
  EXPECT_EQ(describe_request(bytes({6, 0, 128, 0, 7})), "write register 128: 00 07");
  EXPECT_EQ(describe_request(bytes({16, 0, 128, 0, 2, 4, 0, 1, 0, 2})),
            "write registers 128 to 129: 00 01 00 02");
  EXPECT_EQ(describe_request(bytes({43, 14})), "invalid request 2b 0e");
  EXPECT_EQ(describe_response(bytes({3, 2, 0, 7})), "00 07");
  EXPECT_EQ(describe_response(bytes({6, 0, 128, 0, 7})), "written");
  EXPECT_EQ(describe_response(bytes({0x83, 2})), "exception 2");
}

}  // namespace
}  // namespace ur_simulator::modbus
