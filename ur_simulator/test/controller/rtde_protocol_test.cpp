#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class Rtde : public SimulatorTest {
 protected:
  RtdeClient client{controller.address()};
};

TEST_F(Rtde, accepts_protocol_versions_1_and_2_only)
{
  EXPECT_TRUE(client.negotiate(1));
  EXPECT_TRUE(client.negotiate(2));
  EXPECT_FALSE(client.negotiate(3));
  EXPECT_FALSE(client.negotiate(0));
}

TEST_F(Rtde, tells_the_controllers_version)
{
  const std::string version = client.request('v', "");
  ASSERT_EQ(version.size(), 16u);
  EXPECT_EQ(number(version.substr(0, 4)), 5u);
  EXPECT_EQ(number(version.substr(4, 4)), 25u);
  EXPECT_EQ(number(version.substr(8, 4)), 1u);
}

TEST_F(Rtde, answers_an_output_recipe_with_its_types)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.outputs(500.0,
                           "timestamp,actual_q,robot_mode,joint_mode,actual_digital_input_bits,payload_cog,"),
            "\1"
            "DOUBLE,VECTOR6D,INT32,VECTOR6INT32,UINT64,VECTOR3D");
}

TEST_F(Rtde, names_unknown_outputs_and_does_not_start_with_them)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.outputs(500.0, "timestamp,no_such_thing"), std::string("\0", 1) + "DOUBLE,NOT_FOUND");
  EXPECT_FALSE(client.start());
}

TEST_F(Rtde, sends_the_state_each_cycle_after_start)
{
  ASSERT_TRUE(client.negotiate(2));
  client.outputs(500.0, "timestamp,actual_q");
  ASSERT_TRUE(client.start());
  double before = 0.0;
  for (int i = 0; i < 20; ++i) {
    const auto package = client.receive();
    ASSERT_EQ(package.type, 'U');
    ASSERT_EQ(package.payload.size(), 1u + 8u + 48u);
    EXPECT_EQ(package.payload[0], 1);
    const double timestamp = real(package.payload.substr(1, 8));
    if (i > 0) {
      EXPECT_NEAR(timestamp - before, 0.002, 1e-9);
    }
    before = timestamp;
  }
}

TEST_F(Rtde, keeps_to_the_frequency_each_client_asked_for)
{
  ASSERT_TRUE(client.negotiate(2));
  client.outputs(125.0, "timestamp");
  ASSERT_TRUE(client.start());
  double before = real(client.receive('U').payload.substr(1, 8));
  for (int i = 0; i < 10; ++i) {
    const double now = real(client.receive('U').payload.substr(1, 8));
    EXPECT_NEAR(now - before, 0.008, 1e-9);
    before = now;
  }
}

TEST_F(Rtde, speaks_version_1_without_frequency_and_recipe_ids)
{
  EXPECT_EQ(client.request('O', "timestamp"), "DOUBLE");
  ASSERT_TRUE(client.start());
  EXPECT_EQ(client.receive('U').payload.size(), 8u);
}

TEST_F(Rtde, stops_sending_when_paused)
{
  ASSERT_TRUE(client.negotiate(2));
  client.outputs(500.0, "timestamp");
  ASSERT_TRUE(client.start());
  client.receive('U');
  EXPECT_EQ(client.request('P', ""), "\1");
  EXPECT_THROW(client.socket().receive(1, milliseconds(50)), std::runtime_error);
}

TEST_F(Rtde, numbers_input_recipes_from_1_in_the_order_of_requests)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.inputs("input_int_register_0,"),
            "\1"
            "INT32");
  EXPECT_EQ(client.inputs("input_int_register_0,input_double_register_0,"),
            "\2"
            "INT32,DOUBLE");
  EXPECT_EQ(client.inputs("no_such_thing"), std::string("\0", 1) + "NOT_FOUND");
  EXPECT_EQ(client.inputs("external_force_torque"),
            "\3"
            "VECTOR6D");
}

TEST_F(Rtde, lets_one_client_write_a_register_and_gives_it_back_when_the_client_leaves)
{
  ASSERT_TRUE(client.negotiate(2));
  {
    RtdeClient owner(controller.address());
    ASSERT_TRUE(owner.negotiate(2));
    ASSERT_EQ(owner.inputs("input_int_register_5"),
              "\1"
              "INT32");
    EXPECT_EQ(client.inputs("input_int_register_4,input_int_register_5"),
              std::string("\0", 1) + "INT32,IN_USE");
  }
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return state["clients"]["rtde"] == 1; }, seconds(5)));
  EXPECT_EQ(client.inputs("input_int_register_4,input_int_register_5"),
            "\1"
            "INT32,INT32");
}

TEST_F(Rtde, writes_registers_and_shows_them_to_others)
{
  ASSERT_TRUE(client.negotiate(2));
  client.inputs("input_int_register_3,input_double_register_47,input_bit_register_64");
  client.send('U', package_for(1) + int32(-7) + float64(2.5) + "\1");
  RtdeClient reader(controller.address());
  ASSERT_TRUE(reader.negotiate(2));
  reader.outputs(500.0, "input_int_register_3,input_double_register_47,input_bit_register_64");
  ASSERT_TRUE(reader.start());
  std::string payload;
  for (int i = 0; i < 500 && (payload.empty() || payload[13] == 0); ++i) {
    payload = reader.receive('U').payload;
  }
  EXPECT_EQ(payload, package_for(1) + int32(-7) + float64(2.5) + "\1");
}

TEST_F(Rtde, changes_only_the_outputs_its_mask_selects)
{
  ASSERT_TRUE(client.negotiate(2));
  client.inputs("standard_digital_output_mask,standard_digital_output");
  client.send('U', std::string("\1\xf0\xff", 3));
  client.send('U', std::string("\1\x81\x01", 3));
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["io"]["digital_outputs"] == 0x71; },
                                    seconds(5)))
      << controller.state()["io"].dump();
}

TEST_F(Rtde, sets_analog_outputs_as_fraction_of_their_range)
{
  ASSERT_TRUE(client.negotiate(2));
  client.inputs(
      "standard_analog_output_mask,standard_analog_output_type,standard_analog_output_0,standard_analog_"
      "output_1");
  client.send('U', std::string("\1\3\2", 3) + float64(0.5) + float64(0.5));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        const json & outputs = state["io"]["analog_outputs"];
        return std::abs(outputs[0].get<double>() - 0.012) < 1e-12 &&
               std::abs(outputs[1].get<double>() - 5.0) < 1e-12;
      },
      seconds(5)));
}

TEST_F(Rtde, moves_the_speed_slider_only_under_its_mask)
{
  ASSERT_TRUE(client.negotiate(2));
  client.inputs("speed_slider_mask,speed_slider_fraction");
  client.send('U', package_for(1) + int32(1) + float64(0.25));
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return state["speed_slider"] == 0.25; }, seconds(5)));
  client.send('U', package_for(1) + int32(0) + float64(0.75));
  EXPECT_EQ(client.request('v', "").size(), 16u);  // answered after the package was read
  EXPECT_EQ(controller.state()["speed_slider"], 0.25);
}

TEST(RtdeVersions, hide_what_a_version_does_not_have)
{
  SimulatorOptions options;
  options.polyscope_version = "5.4.0";
  SimulatedController controller(on_own_address(options));
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.outputs(500.0, "ft_raw_wrench,payload,timestamp"),
            std::string("\0", 1) + "NOT_FOUND,NOT_FOUND,DOUBLE");
}

TEST(RtdeVersions, a_cb3_controller_runs_at_125_hertz)
{
  SimulatorOptions options;
  options.model = "ur5";
  SimulatedController controller(on_own_address(options));
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(number(client.request('v', "").substr(0, 4)), 3u);
  client.outputs(125.0, "timestamp");
  ASSERT_TRUE(client.start());
  const double first = real(client.receive('U').payload.substr(1, 8));
  EXPECT_NEAR(real(client.receive('U').payload.substr(1, 8)) - first, 0.008, 1e-9);
}

}  // namespace
}  // namespace ur_simulator::testing
