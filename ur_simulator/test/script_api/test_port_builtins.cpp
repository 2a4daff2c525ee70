#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

TEST(PortBuiltinTest, AccessTheDataOfTheModbusServer)
{
  ScriptFixture fixture;
  fixture.state.io.digital_inputs = 0b100;
  fixture.state.ports.general_purpose[2] = 65535;
  EXPECT_EQ(fixture.error_of(R"(def test():
    bit = read_port_bit(2)
    word = read_port_register(130)
    mode = read_port_register(258)
    write_port_register(128, 65535)
    write_port_register(129, -2)
    write_port_register(131, 12.9)
    write_port_register(132, -12.9)
    write_port_bit(17, True)
  end)"),
            "");
  EXPECT_EQ(fixture.global("bit"), "True");
  EXPECT_EQ(fixture.global("word"), "-1");
  EXPECT_EQ(fixture.global("mode"), "7");
  EXPECT_EQ(fixture.state.ports.general_purpose[0], 65535);
  EXPECT_EQ(fixture.state.ports.general_purpose[1], 65534);
  EXPECT_EQ(fixture.state.ports.general_purpose[3], 12);
  EXPECT_EQ(fixture.state.ports.general_purpose[4], 65524);
  EXPECT_EQ(fixture.state.io.digital_outputs, 2U);
}

TEST(PortBuiltinTest, WritingReadOnlyAddressesHasNoEffect)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("write_port_register(410, 512)"), "");
  EXPECT_EQ(fixture.error_of("write_port_bit(0, True)"), "");
  EXPECT_EQ(fixture.state.io.digital_inputs, 0U);
}

TEST(PortBuiltinTest, RejectAddressesAndValuesOutOfRange)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("read_port_register(2054)"),
            "read_port_register: address must be in [0, 2053], is 2054");
  EXPECT_EQ(fixture.error_of("read_port_bit(-1)"), "read_port_bit: address must be in [0, 627], is -1");
  EXPECT_EQ(fixture.error_of("write_port_bit(628, True)"),
            "write_port_bit: address must be in [0, 627], is 628");
  EXPECT_EQ(fixture.error_of("write_port_register(128, 65536)"),
            "write_port_register: value must be in [-32768, 65535], is 65536");
  EXPECT_EQ(fixture.error_of("write_port_register(128, -32769)"),
            "write_port_register: value must be in [-32768, 65535], is -32769");
  EXPECT_EQ(fixture.error_of("write_port_register(20, 13)"),
            "write_port_register: value 13 is not possible at address 20");
  EXPECT_EQ(fixture.error_of("write_port_register(128, \"1\")"),
            "write_port_register: the argument 'value' must be a finite number, not string 1");
}

}  // namespace
}  // namespace ur_simulator
