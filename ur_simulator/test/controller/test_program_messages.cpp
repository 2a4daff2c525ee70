#include <bit>

#include "support/primary_client.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

constexpr char program_state = 25;
constexpr char names_message = 0;
constexpr char values_message = 1;
constexpr std::size_t body_begin = 12;  // after type, timestamp, message type and start index

std::string encode_float(float value)
{
  return encode_uint(std::bit_cast<std::uint32_t>(value), 4);
}

std::uint64_t timestamp(const std::string & message)
{
  return decode_uint(message.substr(1, 8));
}

/// The next names or values of the global variables.
std::string receive_variables(PrimaryClient & client, char type)
{
  for (;;) {
    const std::string message = client.receive_message(program_state);
    if (message[9] == type) {
      return message.substr(body_begin);
    }
  }
}

const std::string program = R"(def variables():
  global flag = True
  global count = 7
  global ratio = 0.5
  global label = "ab"
  global place = p[1, 2, 3, 0, 0, 0]
  global values = [1, 2]
  global grid = [[1.0, 2.0], [3.0, 4.0]]
  sleep(1.0)
  count = -1
  sleep(10.0)
end
)";

using GlobalVariablesTest = SimulatorTest;

TEST_F(GlobalVariablesTest, SendsNamesAndValuesOfAProgram)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(program);
  EXPECT_EQ(receive_variables(client, names_message), "flag\ncount\nratio\nlabel\nplace\nvalues\ngrid\n");
  std::string expected = std::string("\x0d\x01\n") + "\x0f" + encode_int32(7) + "\n\x10" +
                         encode_float(0.5F) + "\n\x04" + encode_uint(2, 2) + "ab\n\x0c";
  for (const float coordinate : {1.0F, 2.0F, 3.0F, 0.0F, 0.0F, 0.0F}) {
    expected += encode_float(coordinate);
  }
  expected += "\n\x11" + encode_uint(2, 2) + "\x0f" + encode_int32(1) + "\x0f" + encode_int32(2) + "\n";
  expected += "\x12" + encode_uint(2, 2) + encode_uint(2, 2);
  for (const float element : {1.0F, 2.0F, 3.0F, 4.0F}) {
    expected += "\x10" + encode_float(element);
  }
  EXPECT_EQ(receive_variables(client, values_message), expected + "\n");
}

TEST_F(GlobalVariablesTest, SendsValuesOnlyAfterAChange)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(program);
  ASSERT_EQ(client.receive_message(program_state)[9], names_message);
  const std::string first = client.receive_message(program_state);
  const std::string second = client.receive_message(program_state);
  EXPECT_EQ(second[9], values_message);
  EXPECT_GE(timestamp(second) - timestamp(first), 900'000U);  // microseconds; robot states every 100'000
  EXPECT_EQ(second.substr(body_begin + 3, 6), "\x0f" + encode_int32(-1) + "\n");
}

TEST_F(GlobalVariablesTest, SendsTheLastValuesOfAShortProgram)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def short():\n  global a = 3\n  a = a + 1\nend\n");
  EXPECT_EQ(receive_variables(client, values_message), "\x0f" + encode_int32(4) + "\n");
}

TEST_F(GlobalVariablesTest, SendsTheLastValuesOfAFailedProgram)
{
  PrimaryClient client(controller.address(), 30001);
  client.socket().send("def short():\n  global a = 3\n  a = a + 1\n  a = a / 0\nend\n");
  EXPECT_EQ(receive_variables(client, values_message), "\x0f" + encode_int32(4) + "\n");
}

TEST_F(GlobalVariablesTest, ANewClientReceivesThemDuringAProgram)
{
  controller.control({{"command", "run_script"}, {"script", program}});
  ASSERT_TRUE(wait_simulated_time(controller, 0.2, seconds(5)));
  PrimaryClient client(controller.address(), 30011);
  EXPECT_EQ(receive_variables(client, names_message).substr(0, 11), "flag\ncount\n");
  EXPECT_EQ(receive_variables(client, values_message).substr(0, 3), "\x0d\x01\n");
}

TEST(GlobalVariablesVersionTest, EarlierVersionsHaveOtherTypeCodes)
{
  SimulatorOptions options;
  options.polyscope_version = "5.8.0";
  SimulatedController controller(with_unique_address(options));
  PrimaryClient client(controller.address(), 30001);
  client.socket().send(
      "def p():\n  global a = True\n  global b = 2\n  global c = 0.5\n  global d = [True]\n"
      "  global e = [[1], [2]]\n  sleep(1)\nend\n");
  EXPECT_EQ(receive_variables(client, values_message),
            std::string("\x0c\x01\n") + "\x0e" + encode_int32(2) + "\n\x0f" + encode_float(0.5F) + "\n\x05" +
                encode_uint(1, 2) + "\x0c\x01\n" + std::string(1, '\0') + "\n");
}

class ValueRequestTest : public SimulatorTest {
 protected:
  /// Runs a program that requests a value. Returns the requested type in the message, and checks its text.
  std::uint64_t request(const std::string & type)
  {
    client.socket().send("def ask():\n  textmsg(\"got \", request_" + type +
                         "_from_primary_client(\"How many?\"))\nend\n");
    const std::string message = client.receive_robot_message(9);
    EXPECT_EQ(message.substr(19), "How many?");
    return decode_uint(message.substr(15, 4));
  }
  json answer(const json & value)
  {
    return controller.control({{"command", "answer_request"}, {"value", value}});
  }
  std::string text() { return client.receive_robot_message(0).substr(11); }

  PrimaryClient client{controller.address(), 30001};
};

TEST_F(ValueRequestTest, TheProgramReceivesTheAnswer)
{
  EXPECT_EQ(request("boolean"), 0U);
  EXPECT_TRUE(answer(true)["ok"]);
  EXPECT_EQ(text(), "got True");
  EXPECT_EQ(request("integer"), 1U);
  EXPECT_TRUE(answer(5)["ok"]);
  EXPECT_EQ(text(), "got 5");
  EXPECT_EQ(request("float"), 2U);
  EXPECT_TRUE(answer(0.25)["ok"]);
  EXPECT_EQ(text(), "got 0.25");
  EXPECT_EQ(request("string"), 3U);
  EXPECT_TRUE(answer("part")["ok"]);
  EXPECT_EQ(text(), "got part");
}

TEST_F(ValueRequestTest, RejectsAnAnswerOfAnotherType)
{
  request("integer");
  EXPECT_EQ(controller.state()["value_request"], "How many?");
  EXPECT_NE(answer(1.5)["error"].get<std::string>().find("field 'value' is 1.5"), std::string::npos);
  EXPECT_EQ(controller.state()["value_request"], "How many?");
}

TEST_F(ValueRequestTest, EndsWithTheProgram)
{
  request("integer");
  controller.control({{"command", "stop_program"}});
  EXPECT_EQ(controller.state()["value_request"], nullptr);
  EXPECT_EQ(answer(1)["error"], "the program does not request a value");
}

TEST_F(ValueRequestTest, ThreadsAskOneAfterTheOther)
{
  client.socket().send(
      "def ask():\n  thread other():\n    textmsg(\"b\", request_string_from_primary_client(\"B\"))\n  end\n"
      "  handle = run other()\n  textmsg(\"a\", request_string_from_primary_client(\"A\"))\n"
      "  join handle\nend\n");
  for (const char * name : {"A", "B"}) {
    EXPECT_EQ(client.receive_robot_message(9).substr(19), name);
    EXPECT_TRUE(answer("!")["ok"]);
    EXPECT_EQ(text(), (name == std::string("A") ? "a!" : "b!"));
  }
}

TEST_F(ValueRequestTest, AnEmptyMessageIsARunTimeError)
{
  client.socket().send("def ask():\n  request_string_from_primary_client(\"\")\nend\n");
  EXPECT_NE(client.receive_robot_message(10).find("the message must not be empty"), std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::testing
