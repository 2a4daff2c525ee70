#include "support/rtde_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

/// After each test the controller must serve a well-behaved client.
class RtdeMalformedDataTest : public SimulatorTest {
 protected:
  void TearDown() override
  {
    RtdeClient client(controller.address());
    ASSERT_TRUE(client.negotiate(2));
    ASSERT_EQ(client.setup_outputs(500.0, "timestamp"),
              "\1"
              "DOUBLE");
    ASSERT_TRUE(client.start());
    const double first = decode_double(client.receive('U').payload.substr(1, 8));
    EXPECT_GT(decode_double(client.receive('U').payload.substr(1, 8)), first);
  }
};

TEST_F(RtdeMalformedDataTest, ClosesConnectionIfPackageSizeIsBelowHeaderSize)
{
  for (const unsigned size : {0u, 1u, 2u}) {
    RtdeClient client(controller.address());
    client.send_raw(encode_uint(size, 2) + "V");
    EXPECT_TRUE(client.socket().closed_by_peer()) << size;
  }
  EXPECT_TRUE(log_contains(controller, "package size is 0"));
}

TEST_F(RtdeMalformedDataTest, IncompletePackageDoesNotAffectOtherClients)
{
  RtdeClient client(controller.address());
  client.send_raw(encode_uint(0xffff, 2) + "V" + std::string(1000, 'x'));
}

TEST_F(RtdeMalformedDataTest, AnswersUnknownPackageTypeWithTextMessage)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('Z', "what");
  const auto message = client.receive();
  EXPECT_EQ(message.type, 'M');
  EXPECT_NE(message.payload.find("Unknown package type 90"), std::string::npos);
  EXPECT_EQ(client.request('v', "").size(), 16u);
}

TEST_F(RtdeMalformedDataTest, InvalidRecipeAfterStartEndsThePackages)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.setup_outputs(500.0, "timestamp");
  ASSERT_TRUE(client.start());
  EXPECT_EQ(client.setup_outputs(500.0, "actual_q,target_q,actual_qd,nothing"),
            std::string(1, '\0') + "VECTOR6D,VECTOR6D,VECTOR6D,NOT_FOUND");
  ASSERT_TRUE(wait_simulated_time(controller, 0.1, seconds(5)));
  client.send('v', "");
  EXPECT_EQ(client.receive().type, 'v');
}

TEST_F(RtdeMalformedDataTest, NewProtocolVersionDiscardsTheOutputRecipe)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(1));
  client.request('O', "timestamp,actual_q");
  ASSERT_TRUE(client.start());
  ASSERT_TRUE(client.negotiate(2));
  EXPECT_FALSE(client.start());
}

TEST_F(RtdeMalformedDataTest, AcceptsPackageByteByByte)
{
  RtdeClient client(controller.address());
  for (const char byte : RtdeClient::package('V', encode_uint(2, 2))) {
    client.send_raw(std::string(1, byte));
  }
  EXPECT_EQ(client.receive('V').payload, "\1");
}

TEST_F(RtdeMalformedDataTest, AcceptsManyPackagesAtOnce)
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

TEST_F(RtdeMalformedDataTest, HandlesEmptyPayloads)
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

TEST_F(RtdeMalformedDataTest, HandlesTextLongerThanPackage)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('M',
              "\xff"
              "short");
  EXPECT_EQ(client.request('v', "").size(), 16u);
}

TEST_F(RtdeMalformedDataTest, IgnoresDataForUnknownRecipe)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.send('U', data_package_header(7) + encode_int32(1));
  EXPECT_EQ(client.request('v', "").size(), 16u);
  EXPECT_TRUE(log_contains(controller, "recipe 7, which was not set up"));
}

TEST_F(RtdeMalformedDataTest, ReadsAvailableFieldsOfShortDataPackage)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs("input_int_register_0,input_double_register_0,input_int_register_1");
  client.send('U', data_package_header(1) + encode_int32(21) + encode_double(1.5));
  client.send('U', data_package_header(1) + encode_int32(22) + "\1\2");
  EXPECT_EQ(client.request('v', "").size(), 16u);
  const json inputs = controller.control({{"command", "registers"}})["inputs"];
  EXPECT_EQ(inputs["integers"][0], 22);
  EXPECT_EQ(inputs["doubles"][0], 1.5);
  EXPECT_EQ(inputs["integers"][1], 0);
}

TEST_F(RtdeMalformedDataTest, IgnoresSurplusOfLongDataPackage)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  client.setup_inputs("input_int_register_0");
  client.send('U', data_package_header(1) + encode_int32(5) + std::string(48, '\x55'));
  EXPECT_EQ(client.request('v', "").size(), 16u);
  EXPECT_EQ(controller.control({{"command", "registers"}})["inputs"]["integers"][0], 5);
}

TEST_F(RtdeMalformedDataTest, ReplacesInvalidFrequencyByHighest)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  for (const double frequency : {0.0, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(client.setup_outputs(frequency, "timestamp"),
              "\1"
              "DOUBLE");
    ASSERT_TRUE(client.start());
    client.receive('U');
    client.request('P', "");
  }
}

TEST_F(RtdeMalformedDataTest, RejectsMoreThan255InputRecipes)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  for (int i = 0; i < 255; ++i) {
    ASSERT_EQ(static_cast<unsigned char>(client.setup_inputs("input_int_register_0")[0]), i + 1);
  }
  EXPECT_EQ(client.setup_inputs("input_int_register_0")[0], 0);
}

TEST_F(RtdeMalformedDataTest, RejectsRecipeTooLargeForPackage)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  std::string names;
  for (int i = 0; i < 1400; ++i) {
    names += "actual_q,";
  }
  EXPECT_EQ(client.setup_outputs(500.0, names)[0], 0);
  EXPECT_FALSE(client.start());
}

TEST_F(RtdeMalformedDataTest, OmitsTypesThatDoNotFitIntoReply)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  std::string names;
  for (int i = 0; i < 10000; ++i) {
    names += "x,";  // the reply for each name is longer: "NOT_FOUND,"
  }
  EXPECT_EQ(client.setup_outputs(500.0, names), std::string("\0", 1));
  EXPECT_EQ(client.setup_inputs(names), std::string("\0", 1));
  EXPECT_TRUE(client.negotiate(2));
}

TEST_F(RtdeMalformedDataTest, DropsPackagesOfClientThatDoesNotRead)
{
  RtdeClient client(controller.address());
  ASSERT_TRUE(client.negotiate(2));
  std::string names;
  for (int i = 0; i < 1300; ++i) {
    names += "actual_q,";
  }
  ASSERT_EQ(client.setup_outputs(500.0, names)[0], 1);
  ASSERT_TRUE(client.start());
  EXPECT_TRUE(controller.wait_until(
      [](const json & state) { return state["clients"]["rtde_dropped_packages"].get<int>() > 10; },
      seconds(20)));
}

TEST_F(RtdeMalformedDataTest, HandlesRandomBytes)
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
