#include <limits>

#include "controller/rtde_value.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr PolyscopeVersion version{5, 25, 1, 0};

std::string text_of(const ControllerState & state, std::string_view name)
{
  const auto value = rtde_value(state, version, name);
  return value ? value->text() : "none";
}

TEST(RtdeValueTest, EachTypeHasItsValue)
{
  ControllerState state;
  state.measured.position = (Vector6() << 0.5, -1, 1.5, 2, -2.5, 3).finished();
  state.robot_mode = RobotMode::running;
  EXPECT_EQ(text_of(state, "actual_q"), "[0.5, -1, 1.5, 2, -2.5, 3]");
  EXPECT_EQ(text_of(state, "robot_mode"), "7");
  EXPECT_EQ(text_of(state, "speed_scaling"), "0") << "no program runs";
  state.runtime_state = RuntimeState::playing;
  EXPECT_EQ(text_of(state, "speed_scaling"), "1");
  EXPECT_EQ(rtde_value(state, version, "actual_digital_output_bits")->type(), urscript::Type::integer);
  EXPECT_EQ(rtde_value(state, version, "output_bit_register_64")->type(), urscript::Type::boolean);
  EXPECT_EQ(rtde_value(state, version, "joint_mode")->list().size(), 6U);
  EXPECT_EQ(rtde_value(state, version, "actual_tool_accelerometer")->list().size(), 3U);
}

TEST(RtdeValueTest, NumbersBeyondTheRangeOfIntegersAreFloating)
{
  ControllerState state;
  for (unsigned i = 0; i < 32; ++i) {
    state.outputs.bits[i] = true;
  }
  const auto value = rtde_value(state, version, "output_bit_registers0_to_31");
  ASSERT_TRUE(value);
  EXPECT_EQ(value->type(), urscript::Type::floating);
  EXPECT_EQ(value->number(), 4294967295.0);
}

TEST(RtdeValueTest, OutputsOfOtherVersionsDoNotExist)
{
  EXPECT_FALSE(rtde_value(ControllerState(), {5, 4, 0, 0}, "tcp_offset"));
  EXPECT_FALSE(rtde_value(ControllerState(), version, "no_such_output"));
}

TEST(RtdeValueTest, AProgramReadsOutputs)
{
  SimulatedController controller(with_unique_address());
  controller.control({{"command", "run_script"},
                      {"script",
                       "def read():\n  sync()\n  textmsg(\"mode is \", get_rtde_value(\"robot_mode\"))\n"
                       "  get_rtde_value(\"nonsense\")\nend\n"}});
  EXPECT_TRUE(wait_for_log(controller, "mode is 7"));
  EXPECT_TRUE(wait_for_log(controller, "there is no RTDE output 'nonsense' in this version"));
}

}  // namespace
}  // namespace ur_simulator::testing
