#include "kinematics/forward_kinematics.hpp"
#include "script_fixture.hpp"

namespace ur_simulator {
namespace {

using urscript::MachineStatus;

TEST(RegisterTest, AreReadAndWrittenWithinTheirRange)
{
  ScriptFixture fixture;
  fixture.state.inputs.integers[3] = 42;
  fixture.state.inputs.floats[47] = 0.5F;
  fixture.state.inputs.bits[127] = true;
  EXPECT_EQ(fixture.error_of(R"(def test():
    write_output_integer_register(0, read_input_integer_register(3) + 1)
    write_output_float_register(24, read_input_float_register(47))
    write_output_boolean_register(64, read_input_boolean_register(127))
    x = read_output_integer_register(0)
  end)"),
            "");
  EXPECT_EQ(fixture.state.outputs.integers[0], 43);
  EXPECT_EQ(fixture.state.outputs.floats[24], 0.5F);
  EXPECT_TRUE(fixture.state.outputs.bits[64]);
  EXPECT_EQ(fixture.global("x"), "43");
  EXPECT_EQ(fixture.error_of("write_output_float_register(0, 556.044)"), "");
  EXPECT_EQ(fixture.state.outputs.floats[0], 556.04400634765625);  // measured on a controller
  EXPECT_EQ(fixture.error_of("write_output_integer_register(48, 1)"),
            "write_output_integer_register: address must be in [0, 47], is 48");
  EXPECT_EQ(fixture.error_of("write_output_integer_register(0, 0.5)"),
            "write_output_integer_register: the argument 'value' must be an int, not float 0.5");
}

TEST(DigitalIoTest, AccessesStandardConfigurableAndToolBits)
{
  ScriptFixture fixture;
  fixture.state.io.digital_inputs = (1U << 2U) | (1U << 9U) | (1U << 17U);
  EXPECT_EQ(fixture.error_of(R"(def test():
    a = get_standard_digital_in(2) and get_configurable_digital_in(1) and get_tool_digital_in(1) and get_digital_in(9)
    set_standard_digital_out(7, True)
    set_configurable_digital_out(0, True)
    set_tool_digital_out(0, get_standard_digital_out(7))
    set_standard_digital_out(7, False)
    set_digital_out(1, 1)
    set_flag(31, True)
    f = get_flag(31)
  end)"),
            "");
  EXPECT_EQ(fixture.global("a"), "True");
  EXPECT_EQ(fixture.global("f"), "True");
  EXPECT_EQ(fixture.state.io.digital_outputs, (1U << 1U) | (1U << 8U) | (1U << 16U));
  EXPECT_EQ(fixture.error_of("set_standard_digital_out(8, True)"),
            "set_standard_digital_out: n must be in [0, 7], is 8");
}

TEST(AnalogIoTest, ScalesLevelsByTheDomain)
{
  ScriptFixture fixture;
  EXPECT_EQ(
      fixture.error_of(
          "def test():\n set_analog_outputdomain(1, 1)\n set_standard_analog_out(0, 0.5)\n "
          "set_standard_analog_out(1, 0.5)\n x = get_standard_analog_out(1)\n set_tool_voltage(24)\nend"),
      "");
  EXPECT_DOUBLE_EQ(fixture.state.io.analog_outputs[0], 0.012);
  EXPECT_DOUBLE_EQ(fixture.state.io.analog_outputs[1], 5.0);
  EXPECT_EQ(fixture.state.io.analog_io_types, 8U);
  EXPECT_EQ(fixture.global("x"), "0.5");
  EXPECT_EQ(fixture.state.io.tool_output_voltage, 24);
  EXPECT_EQ(fixture.error_of("set_tool_voltage(5)"), "set_tool_voltage: voltage must be 0, 12 or 24, is 5");
}

TEST(InstallationBuiltinsTest, SetsPayloadTcpAndGravity)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    set_target_payload(2.5, [0.1, 0, 0.05], [0.01, 0.02, 0.03, 0, 0, 0])
    set_tcp(p[0, 0, 0.1, 0, 0, 0])
    set_gravity([0, 9.82, 0])
    m = get_target_payload()
    c = get_target_payload_cog()
    tcp = get_tcp_offset()
    pose = get_actual_tcp_pose()
  end)"),
            "");
  EXPECT_EQ(fixture.global("m"), "2.5");
  EXPECT_EQ(fixture.global("c"), "[0.1, 0, 0.05]");
  EXPECT_EQ(fixture.global("tcp"), "p[0, 0, 0.1, 0, 0, 0]");
  EXPECT_EQ(fixture.state.payload.inertia[2], 0.03);
  EXPECT_EQ(fixture.state.gravity.y(), 9.82);
  EXPECT_EQ(
      fixture.global("pose"),
      urscript::Value::pose(tcp_pose(fixture.model, fixture.state.actual.position, fixture.state.tcp_offset))
          .text());
  EXPECT_NE(fixture.error_of("set_target_payload(1, [0,0,0], [-1,0,0,0,0,0])").find("must not be negative"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("set_target_payload(1, [0,0,0], [1,0,0,0,0,134])").find("within 133"),
            std::string::npos);
  EXPECT_NE(fixture.error_of("set_payload(100)").find("kg for a UR10e, is 100 kg"), std::string::npos);
  EXPECT_NE(fixture.error_of("set_payload(-1)").find("kg for a UR10e, is -1 kg"), std::string::npos);
}

TEST(InstallationBuiltinsTest, TheTargetPayloadZeroesTheSensor)
{
  ScriptFixture fixture;
  fixture.world.attach_load({.mass = 2.0});
  EXPECT_EQ(fixture.error_of("def test():\n set_payload(0)\n sleep(0.5)\n held = get_tcp_force()\n "
                             "set_target_payload(0, [0,0,0])\n sleep(0.1)\n zeroed = get_tcp_force()\nend"),
            "");
  const auto force = [&](const char * name) { return fixture.machine->global(name)->pose()[2]; };
  EXPECT_LT(force("held"), -15.0);
  EXPECT_NEAR(force("zeroed"), 0.0, 1.0);
}

TEST(StateBuiltinsTest, WrenchesAndSpeedsOfTheTcpArePoses)
{
  ScriptFixture fixture;
  for (const char * name : {"get_tcp_force", "get_actual_tcp_speed", "get_target_tcp_speed"}) {
    EXPECT_EQ(fixture.error_of(fmt::format("def test():\n x = {}()\nend", name)), "");
    EXPECT_EQ(fixture.global("x").substr(0, 2), "p[") << name;
  }
}

TEST(KinematicsBuiltinsTest, ForwardAndInverseAgree)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    q = get_target_joint_positions()
    x = get_forward_kin(q)
    error = norm(get_inverse_kin(x, q) - q)
    x6 = get_forward_kin(q, p[0, 0, 0.2, 0, 0, 0])
    error_tcp = norm(get_inverse_kin(x6, q, tcp=p[0, 0, 0.2, 0, 0, 0]) - q)
    yes = get_inverse_kin_has_solution(x)
    no = get_inverse_kin_has_solution(p[5, 0, 0, 0, 0, 0])
    inside = is_within_safety_limits(q) and is_within_safety_limits(x) and is_within_safety_limits(position=x, qNear=q)
    outside = is_within_safety_limits([100, 0, 0, 0, 0, 0])
    flange = get_actual_tool_flange_pose()
  end)"),
            "");
  EXPECT_LT(fixture.machine->global("error")->number().value(), 1e-8);
  EXPECT_LT(fixture.machine->global("error_tcp")->number().value(), 1e-8);
  EXPECT_EQ(fixture.global("yes"), "True");
  EXPECT_EQ(fixture.global("no"), "False");
  EXPECT_EQ(fixture.global("inside"), "True");
  EXPECT_EQ(fixture.global("outside"), "False");
  EXPECT_NE(fixture.error_of("def t():\n q = get_inverse_kin(p[5,0,0,0,0,0])\nend").find("out of reach"),
            std::string::npos);
}

TEST(DynamicsBuiltinsTest, ReturnMatrices)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of(R"(def test():
    m = get_mass_matrix()
    symmetric = norm([m[0, 1] - m[1, 0], m[2, 5] - m[5, 2]]) < 0.000000001
    j = get_jacobian()
    v = get_actual_tcp_speed()
    speed = norm(j * get_actual_joint_speeds() - [v[0], v[1], v[2], v[3], v[4], v[5]])
    c = norm(get_coriolis_and_centrifugal_torques())
    d = get_jacobian_time_derivative()
    s = size(d)
  end)"),
            "");
  EXPECT_EQ(fixture.global("symmetric"), "True");
  EXPECT_LT(fixture.machine->global("speed")->number().value(), 1e-9);
  EXPECT_EQ(fixture.global("c"), "0");
  EXPECT_EQ(fixture.global("s"), "[6, 6]");
}

TEST(AnalogInputsTest, HaveThoseOfTheToolAsTwoAndThree)
{
  ScriptFixture fixture;
  fixture.state.io.analog_inputs = {0.25, 0.5};
  fixture.state.io.tool_analog_inputs = {0.75, 1.0};
  EXPECT_EQ(fixture.error_of(
                "def test():\n a = [get_analog_in(0), get_analog_in(1), analog_in[2], get_analog_in(3)]\n"
                "end"),
            "");
  EXPECT_EQ(fixture.global("a"), "[0.25, 0.5, 0.75, 1]");
  EXPECT_NE(fixture.error_of("def t():\n a = get_analog_in(4)\nend").find("n must be in [0, 3]"),
            std::string::npos);
}

TEST(StateBuiltinsTest, ReportForcesAndHistory)
{
  ScriptFixture fixture;
  fixture.cycles(5);
  Vector6 earlier = fixture.state.actual.position;
  earlier[0] += 1.0;
  fixture.history.record(earlier);
  fixture.run(
      "def test():\n a = get_actual_joint_positions_history(1)\n dt = get_steptime()\n f = force()\n "
      "zero_ftsensor()\n"
      " steady = is_steady()\n t = get_joint_temp(0)\n tau = norm(get_joint_torques())\nend");
  fixture.history.record(fixture.state.actual.position);
  fixture.finish();
  EXPECT_EQ(fixture.machine->status(), MachineStatus::finished) << fixture.machine->error().message;
  EXPECT_EQ(fixture.global("a"), urscript::Value::list(earlier).text());
  EXPECT_EQ(fixture.global("dt"), "0.002");
  EXPECT_NE(fixture.error_of("def t():\n x = get_actual_joint_positions_history(2000)\nend")
                .find("the joint positions of 2000 steps ago are not stored"),
            std::string::npos);
}

TEST(ScriptRequestTest, AreForwardedToTheController)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("def t():\n protective_stop()\n powerdown()\nend"), "");
  ASSERT_TRUE(fixture.protective_stop.has_value());
  EXPECT_EQ(fixture.protective_stop->code, 209);
  EXPECT_TRUE(fixture.powered_down);
}

TEST(WatchdogBuiltinTest, ExpiresIfItIsNotFed)
{
  ScriptFixture fixture;
  EXPECT_EQ(fixture.error_of("rtde_set_watchdog(\"input_int_register_0\", 10, \"stop\")"), "");
  const double start = fixture.state.timestamp;
  EXPECT_EQ(fixture.watchdog.expired(start + 0.05), std::nullopt);
  fixture.watchdog.feed("input_int_register_0", start + 0.08);
  fixture.watchdog.feed("input_int_register_1", start + 0.2);
  EXPECT_EQ(fixture.watchdog.expired(start + 0.15), std::nullopt);
  EXPECT_EQ(fixture.watchdog.expired(start + 0.2), Watchdog::Action::stop);
  EXPECT_EQ(fixture.watchdog.expired(start + 0.3), std::nullopt);
  fixture.watchdog.feed("input_int_register_0", start + 0.3);
  EXPECT_EQ(fixture.watchdog.expired(start + 0.5), Watchdog::Action::stop);
  fixture.watchdog.clear();
  EXPECT_EQ(fixture.watchdog.expired(start + 9.0), std::nullopt);
  EXPECT_NE(fixture.error_of("rtde_set_watchdog(\"x\", 10, \"explode\")").find("explode"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator
