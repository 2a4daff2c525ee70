#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

/// After every attack a well-behaved client must find the controller as before.
class HostileRtde : public SimulatorTest {
 protected:
  void TearDown() override
  {
    RtdeClient client(controller.address());
    ASSERT_TRUE(client.negotiate(2));
    ASSERT_EQ(client.outputs(500.0, "timestamp"),
              "\1"
              "DOUBLE");
    ASSERT_TRUE(client.start());
    const double first = real(client.receive('U').payload.substr(1, 8));
    EXPECT_GT(real(client.receive('U').payload.substr(1, 8)), first);
  }
};

TEST_F(HostileRtde, package_sizes_below_the_header_end_the_connection)
{
  for (const unsigned size : {0u, 1u, 2u}) {
    RtdeClient client(controller.address());
    client.send_raw(big_endian(size, 2) + "V");
    EXPECT_TRUE(client.socket().closed_by_peer()) << size;
  }
  EXPECT_TRUE(logged(controller, "package size is 0"));
}

TEST_F(HostileRtde, a_package_that_never_completes_disturbs_nobody)
{
  RtdeClient client(controller.address());
  client.send_raw(big_endian(0xffff, 2) + "V" + std::string(1000, 'x'));
}

TEST_F(HostileRtde, unknown_types_are_answered_with_a_message_and_skipped)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('Z', "what");
  const auto message = client.receive();
  EXPECT_EQ(message.type, 'M');
  EXPECT_NE(message.payload.find("Unknown package type 90"), std::string::npos);
  EXPECT_EQ(client.request('v', "").size(), 16u);
}

TEST_F(HostileRtde, packages_may_arrive_byte_by_byte)
{
  RtdeClient client(controller.address());
  for (const char byte : RtdeClient::package('V', big_endian(2, 2))) {
    client.send_raw(std::string(1, byte));
  }
  EXPECT_EQ(client.receive('V').payload, "\1");
}

TEST_F(HostileRtde, many_packages_may_arrive_at_once)
{
  RtdeClient client(controller.address());
  std::string all;
  for (int i = 0; i < 100; ++i) {
    all += RtdeClient::package('v', "");
  }
  client.send_raw(all);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(client.receive('v').payload.size(), 16u);
  }
}

TEST_F(HostileRtde, empty_payloads_are_survived)
{
  RtdeClient client(controller.address());
  EXPECT_EQ(client.request('V', ""), std::string("\0", 1));
  ASSERT_TRUE(client.negotiate(2));
  client.send('U', "");
  client.send('M', "");
  EXPECT_EQ(client.request('I', ""), std::string("\0", 1));
  client.request('O', "");
  EXPECT_FALSE(client.start());
}

TEST_F(HostileRtde, texts_longer_than_their_package_are_survived)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('M',
              "\xff"
              "short");
  EXPECT_EQ(client.request('v', "").size(), 16u);
}

TEST_F(HostileRtde, data_for_a_recipe_that_does_not_exist_is_ignored)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('U', package_for(7) + int32(1));
  EXPECT_EQ(client.request('v', "").size(), 16u);
  EXPECT_TRUE(logged(controller, "recipe 7, which was not set up"));
}

TEST_F(HostileRtde, of_a_short_data_package_the_fields_that_are_there_are_taken)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.inputs("input_int_register_0,input_double_register_0,input_int_register_1");
  client.send('U', package_for(1) + int32(21) + float64(1.5));
  client.send('U', package_for(1) + int32(22) + "\1\2");
  EXPECT_EQ(client.request('v', "").size(), 16u);
  const json inputs = controller.control({{"command", "registers"}})["inputs"];
  EXPECT_EQ(inputs["integers"][0], 22);
  EXPECT_EQ(inputs["doubles"][0], 1.5);
  EXPECT_EQ(inputs["integers"][1], 0);
}

TEST_F(HostileRtde, of_a_long_data_package_the_surplus_is_ignored)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.inputs("input_int_register_0");
  client.send('U', package_for(1) + int32(5) + std::string(48, '\x55'));
  EXPECT_EQ(client.request('v', "").size(), 16u);
  EXPECT_EQ(controller.control({{"command", "registers"}})["inputs"]["integers"][0], 5);
}

TEST_F(HostileRtde, frequencies_that_make_no_sense_become_the_highest)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  for (const double frequency : {0.0, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(client.outputs(frequency, "timestamp"),
              "\1"
              "DOUBLE");
    ASSERT_TRUE(client.start());
    client.receive('U');
    client.request('P', "");
  }
}

TEST_F(HostileRtde, more_recipes_than_a_byte_can_number_are_refused)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  for (int i = 0; i < 255; ++i) {
    ASSERT_EQ(static_cast<unsigned char>(client.inputs("input_int_register_0")[0]), i + 1);
  }
  EXPECT_EQ(client.inputs("input_int_register_0")[0], 0);
}

TEST_F(HostileRtde, a_recipe_too_large_for_a_package_is_not_started)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  std::string names;
  for (int i = 0; i < 1400; ++i) {
    names += "actual_q,";
  }
  EXPECT_EQ(client.outputs(500.0, names)[0], 0);
  EXPECT_FALSE(client.start());
}

TEST_F(HostileRtde, a_client_that_never_reads_loses_packages_and_delays_nobody)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  std::string names;
  for (int i = 0; i < 1300; ++i) {
    names += "actual_q,";
  }
  ASSERT_EQ(client.outputs(500.0, names)[0], 1);
  ASSERT_TRUE(client.start());
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return state["clients"]["rtde_dropped_packages"].get<int>() > 10; },
      seconds(20)));
}

TEST_F(HostileRtde, noise_of_any_kind_is_survived)
{
  unsigned seed = 12345;
  for (int round = 0; round < 50; ++round) {
    RtdeClient client(controller.address());
    std::string noise;
    for (int i = 0; i < 300; ++i) {
      seed = seed * 1664525u + 1013904223u;
      noise += static_cast<char>(seed >> 24);
    }
    client.send_raw(
        RtdeClient::package("VvMUOISP"[round % 8], noise.substr(0, static_cast<std::size_t>(round) * 5)));
    client.send_raw(noise);
  }
}

}  // namespace
}  // namespace ur_simulator::testing
