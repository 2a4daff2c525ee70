#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class RtdeTest : public SimulatorTest {
 protected:
  RtdeClient client{controller.address()};
};

TEST_F(RtdeTest, AcceptsOnlyProtocolVersions1And2)
{
  EXPECT_TRUE(client.negotiate(1));
  EXPECT_TRUE(client.negotiate(2));
  EXPECT_FALSE(client.negotiate(3));
  EXPECT_FALSE(client.negotiate(0));
}

TEST_F(RtdeTest, ReportsControllerVersion)
{
  const std::string version = client.request('v', "");
  ASSERT_EQ(version.size(), 16u);
  EXPECT_EQ(decode_uint(version.substr(0, 4)), 5u);
  EXPECT_EQ(decode_uint(version.substr(4, 4)), 25u);
  EXPECT_EQ(decode_uint(version.substr(8, 4)), 1u);
}

TEST_F(RtdeTest, RepliesToOutputRecipeWithTypes)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.setup_outputs(
                500.0, "timestamp,actual_q,robot_mode,joint_mode,actual_digital_input_bits,payload_cog,"),
            "\1"
            "DOUBLE,VECTOR6D,INT32,VECTOR6INT32,UINT64,VECTOR3D");
}

TEST_F(RtdeTest, RejectsRecipeWithUnknownOutputs)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.setup_outputs(500.0, "timestamp,no_such_thing"),
            std::string("\0", 1) + "DOUBLE,NOT_FOUND");
  EXPECT_FALSE(client.start());
}

TEST_F(RtdeTest, SendsStateInEachCycleAfterStart)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_outputs(500.0, "timestamp,actual_q");
  ASSERT_TRUE(client.start());
  double before = 0.0;
  for (int i = 0; i < 20; ++i) {
    const auto package = client.receive();
    ASSERT_EQ(package.type, 'U');
    ASSERT_EQ(package.payload.size(), 1u + 8u + 48u);
    EXPECT_EQ(package.payload[0], 1);
    const double timestamp = decode_double(package.payload.substr(1, 8));
    if (i > 0) {
      EXPECT_NEAR(timestamp - before, 0.002, 1e-9);
    }
    before = timestamp;
  }
}

TEST_F(RtdeTest, SendsAtRequestedFrequency)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_outputs(125.0, "timestamp");
  ASSERT_TRUE(client.start());
  double before = decode_double(client.receive('U').payload.substr(1, 8));
  for (int i = 0; i < 10; ++i) {
    const double now = decode_double(client.receive('U').payload.substr(1, 8));
    EXPECT_NEAR(now - before, 0.008, 1e-9);
    before = now;
  }
}

TEST_F(RtdeTest, SupportsProtocolVersion1)
{
  EXPECT_EQ(client.request('O', "timestamp"), "DOUBLE");
  ASSERT_TRUE(client.start());
  EXPECT_EQ(client.receive('U').payload.size(), 8u);
}

TEST_F(RtdeTest, StopsSendingWhenPaused)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_outputs(500.0, "timestamp");
  ASSERT_TRUE(client.start());
  client.receive('U');
  EXPECT_EQ(client.request('P', ""), "\1");
  EXPECT_THROW(client.socket().receive(1, milliseconds(50)), std::runtime_error);
}

TEST_F(RtdeTest, NumbersInputRecipesFrom1)
{
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.setup_inputs("input_int_register_0,"),
            "\1"
            "INT32");
  EXPECT_EQ(client.setup_inputs("input_int_register_0,input_double_register_0,"),
            "\2"
            "INT32,DOUBLE");
  EXPECT_EQ(client.setup_inputs("no_such_thing"), std::string("\0", 1) + "NOT_FOUND");
  EXPECT_EQ(client.setup_inputs("external_force_torque"),
            "\3"
            "VECTOR6D");
}

TEST_F(RtdeTest, ReservesInputForClientUntilItDisconnects)
{
  ASSERT_TRUE(client.negotiate(2));
  {
    RtdeClient owner(controller.address());
    ASSERT_TRUE(owner.negotiate(2));
    ASSERT_EQ(owner.setup_inputs("input_int_register_5"),
              "\1"
              "INT32");
    EXPECT_EQ(client.setup_inputs("input_int_register_4,input_int_register_5"),
              std::string("\0", 1) + "INT32,IN_USE");
  }
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return state["clients"]["rtde"] == 1; }, seconds(5)));
  EXPECT_EQ(client.setup_inputs("input_int_register_4,input_int_register_5"),
            "\1"
            "INT32,INT32");
}

TEST_F(RtdeTest, WritesRegistersThatOtherClientsCanRead)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs("input_int_register_3,input_double_register_47,input_bit_register_64");
  client.send('U', data_package_header(1) + encode_int32(-7) + encode_double(2.5) + "\1");
  RtdeClient reader(controller.address());
  ASSERT_TRUE(reader.negotiate(2));
  reader.setup_outputs(500.0, "input_int_register_3,input_double_register_47,input_bit_register_64");
  ASSERT_TRUE(reader.start());
  std::string payload;
  for (int i = 0; i < 500 && (payload.empty() || payload[13] == 0); ++i) {
    payload = reader.receive('U').payload;
  }
  EXPECT_EQ(payload, data_package_header(1) + encode_int32(-7) + encode_double(2.5) + "\1");
}

TEST_F(RtdeTest, ChangesOnlyOutputsSelectedByMask)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs("standard_digital_output_mask,standard_digital_output");
  client.send('U', std::string("\1\xf0\xff", 3));
  client.send('U', std::string("\1\x81\x01", 3));
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["io"]["digital_outputs"] == 0x71; },
                                    seconds(5)))
      << controller.state()["io"].dump();
}

TEST_F(RtdeTest, SetsAnalogOutputsAsFractionOfRange)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs(
      "standard_analog_output_mask,standard_analog_output_type,standard_analog_output_0,standard_analog_"
      "output_1");
  client.send('U', std::string("\1\3\2", 3) + encode_double(0.5) + encode_double(0.5));
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) {
        const json & outputs = state["io"]["analog_outputs"];
        return std::abs(outputs[0].get<double>() - 0.012) < 1e-12 &&
               std::abs(outputs[1].get<double>() - 5.0) < 1e-12;
      },
      seconds(5)));
}

TEST_F(RtdeTest, SetsSpeedSliderOnlyWithMask)
{
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs("speed_slider_mask,speed_slider_fraction");
  client.send('U', data_package_header(1) + encode_int32(1) + encode_double(0.25));
  ASSERT_TRUE(
      controller.wait_until([](const json & state) { return state["speed_slider"] == 0.25; }, seconds(5)));
  client.send('U', data_package_header(1) + encode_int32(0) + encode_double(0.75));
  EXPECT_EQ(client.request('v', "").size(), 16u);  // answered after the package was read
  EXPECT_EQ(controller.state()["speed_slider"], 0.25);
}

SimulatorOptions options_with_version(const std::string & version)
{
  SimulatorOptions options;
  options.polyscope_version = version;
  return with_unique_address(options);
}

TEST(RtdeVersionTest, OmitsFieldsOfLaterVersions)
{
  SimulatedController controller(options_with_version("5.4.0"));
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(client.setup_outputs(500.0, "ft_raw_wrench,payload,timestamp"),
            std::string("\0", 1) + "NOT_FOUND,NOT_FOUND,DOUBLE");
}

TEST(RtdeVersionTest, Polyscope53HasLowerAndUpperRegisters)
{
  SimulatedController controller(options_with_version("5.3.0"));
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(
      client.setup_outputs(500.0, "output_int_register_0,output_double_register_23,output_int_register_24"),
      "\1"
      "INT32,DOUBLE,INT32");
  EXPECT_EQ(client.setup_inputs("input_int_register_0,input_double_register_24"),
            "\1"
            "INT32,DOUBLE");
}

TEST(RtdeVersionTest, Cb3ControllerRunsAt125Hertz)
{
  SimulatorOptions options;
  options.model = "ur5";
  SimulatedController controller(with_unique_address(options));
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_EQ(decode_uint(client.request('v', "").substr(0, 4)), 3u);
  client.setup_outputs(125.0, "timestamp");
  ASSERT_TRUE(client.start());
  const double first = decode_double(client.receive('U').payload.substr(1, 8));
  EXPECT_NEAR(decode_double(client.receive('U').payload.substr(1, 8)) - first, 0.008, 1e-9);
}

}  // namespace
}  // namespace ur_simulator::testing
