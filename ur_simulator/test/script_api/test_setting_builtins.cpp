#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

TEST(SettingBuiltinTest, ChecksItsArguments)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("set_tool_communication(True, 115200, 0, 1, 1.5, 3.5)"), "");
  EXPECT_EQ(fixture.error_of("tool_wrench_limit_set(p[0, 0, 0.1, 0, 0, 0], Fz=20)"), "");
  EXPECT_EQ(fixture.error_of("set_baselight_solid(0, 256, 0)"),
            "set_baselight_solid: g must be in [0, 255], is 256");
  EXPECT_EQ(fixture.error_of("set_standard_digital_input_action(0, 1)"),
            "set_standard_digital_input_action: the argument 'action' must be a string, not int 1");
}

TEST(SettingBuiltinTest, StoredSettingsCanBeReadBack)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("def test():\n motion_version_set(2)\n jerk_gain_scaling_set(0.5)\n"
                             " set_base_acceleration([0, 0.1, 0])\n force_mode_set_damping(0.1)\n"
                             " force_mode_set_gain_scaling(1.5)\n set_gravity([0, 0, 9.8])\n"
                             " x = [motion_version_get(), jerk_gain_scaling_get(), get_base_acceleration(),"
                             " force_mode_get_damping(), force_mode_get_gain_scaling(), get_gravity()]\nend"),
            "");
  EXPECT_EQ(fixture.global("x"), "[2, 0.5, [0, 0.1, 0], 0.1, 1.5, [0, 0, 9.8]]");
  EXPECT_EQ(fixture.error_of("motion_version_set(3)"), "motion_version_set: version must be 1 or 2, is 3");
}

TEST(EncoderTest, CountsWhatTheProgramSets)
{
  ScriptFixture fixture;
  EXPECT_EQ(
      fixture.error_of("def test():\n encoder_enable_set_tick_count(1, 0)\n encoder_set_tick_count(1, -6)\n"
                       " x = [encoder_get_tick_count(1), encoder_get_tick_count(1, opt=\"raw\"),"
                       " encoder_get_tick_count(0)]\nend"),
      "");
  EXPECT_EQ(fixture.global("x"), "[65530, -6, 0]");
  EXPECT_EQ(fixture.error_of(
                "def test():\n encoder_enable_set_tick_count(0, 1)\n encoder_set_tick_count(0, 256)\nend"),
            "encoder_set_tick_count: the count 256 is outside the range of the encoder");
  EXPECT_EQ(fixture.error_of(
                "def test():\n encoder_enable_pulse_decode(0, 1, 0, 1)\n encoder_set_tick_count(0, 1)\nend"),
            "encoder_set_tick_count: the encoder is not enabled with encoder_enable_set_tick_count");
}

TEST(EncoderTest, UnwindsADifferenceAcrossTheEndOfTheRange)
{
  ScriptFixture fixture;
  EXPECT_EQ(
      fixture.error_of("def test():\n encoder_enable_set_tick_count(0, 2)\n"
                       " x = [encoder_unwind_delta_tick_count(0, 864 - 65530),"
                       " encoder_unwind_delta_tick_count(0, 100)]\n"
                       " set_conveyor_tick_count(255, 1)\n"
                       " y = [get_conveyor_tick_count(), encoder_unwind_delta_tick_count(0, -250)]\nend"),
      "");
  EXPECT_EQ(fixture.global("x"), "[870, 100]");
  EXPECT_EQ(fixture.global("y"), "[255, 6]");
}

TEST(EarlierVersionTest, IndexedNamesAccessInputsAndOutputs)
{
  ScriptFixture fixture;
  fixture.state.io.digital_inputs = 1U << 3U;
  fixture.state.io.analog_inputs = {2.5, 0.0};
  EXPECT_EQ(fixture.error_of("digital_out[2]=True"), "");
  EXPECT_EQ(fixture.state.io.digital_outputs, 1U << 2U);
  EXPECT_EQ(
      fixture.error_of("def test():\r\n set_analog_outputdomain(0, 1)\r\n analog_out[0] = 0.5\r\n"
                       " x = [digital_in[3], digital_out[2], digital_out[3], analog_in[0], analog_out[0]]\r\n"
                       "end\r\n"),
      "");
  EXPECT_EQ(fixture.global("x"), "[True, True, False, 2.5, 0.5]");
  EXPECT_EQ(fixture.error_of("digital_out[10] = True"), "set_digital_out: n must be in [0, 9], is 10");
  EXPECT_EQ(urscript::compile("digital_in[1] = True", *fixture.library).error().message,
            "'digital_in' can only be read");
}

TEST(EarlierVersionTest, VariablesOfAProgramHideIndexedNames)
{
  ScriptFixture fixture;
  EXPECT_EQ(
      fixture.error_of("def test():\n digital_out = [1, 2]\n digital_out[1] = 3\n x = digital_out[1]\nend"),
      "");
  EXPECT_EQ(fixture.global("x"), "3");
  EXPECT_EQ(fixture.state.io.digital_outputs, 0U);
}

TEST(EarlierVersionTest, FormerArgumentNamesAreAccepted)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("def test():\n speedj([0.1, 0, 0, 0, 0, 0], 0.5, t_min=0.01)\n stopj(5)\n"
                             " set_payload(1.5, CoG=[0, 0, 0.1])\n x = get_joint_positions()\nend"),
            "");
  EXPECT_EQ(fixture.state.payload.center_of_gravity.z(), 0.1);
  EXPECT_FALSE(urscript::compile("speedj([0, 0, 0, 0, 0, 0], 1, time=1)", *fixture.library).has_value());
}

}  // namespace
}  // namespace ur_simulator
