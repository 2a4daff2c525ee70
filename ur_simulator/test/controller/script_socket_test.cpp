#include "support/one_answer.hpp"
#include "support/simulator_test.hpp"

namespace ur_simulator::testing {
namespace {

class ScriptSockets : public SimulatorTest {
 protected:
  OneAnswer host{controller.address()};

  void run(const std::string & body)
  {
    const std::string open = " global opened = socket_open(\"" + controller.address() + "\", " +
                             std::to_string(host.port()) + ", \"host\")\n";
    const json reply = controller.control(
        {{"command", "run_script"}, {"script", "def test():\n" + open + body + "\nend\n"}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
  bool wait_for_end() { return wait_for_program(controller, "STOPPED"); }
};

TEST_F(ScriptSockets, speak_line_by_line)
{
  run(" socket_send_line(\"how are you\", \"host\")\n answer = socket_read_line(\"host\")\n"
      " textmsg(\"heard: \", answer)\n socket_close(\"host\")");
  EXPECT_EQ(host.request(), "how are you\n");
  ASSERT_TRUE(host.answer("fine\r\n"));
  ASSERT_TRUE(wait_for_end());
  EXPECT_TRUE(logged(controller, "heard: fine"));
}

TEST_F(ScriptSockets, read_numbers_as_text_and_as_bytes)
{
  run(" socket_send_line(\"go\", \"host\")\n"
      " a = socket_read_ascii_float(2, \"host\")\n textmsg(\"floats: \", a)\n"
      " b = socket_read_binary_integer(1, \"host\")\n textmsg(\"integers: \", b)\n"
      " c = socket_read_byte_list(2, \"host\")\n textmsg(\"bytes: \", c)");
  EXPECT_EQ(host.request(), "go\n");
  ASSERT_TRUE(host.answer(std::string("(1.5, -2)\0\0\1\2\7\x9", 15)));
  ASSERT_TRUE(wait_for_end());
  EXPECT_TRUE(logged(controller, "floats: [2, 1.5, -2]"));
  EXPECT_TRUE(logged(controller, "integers: [1, 258]"));
  EXPECT_TRUE(logged(controller, "bytes: [2, 7, 9]"));
}

TEST_F(ScriptSockets, give_up_when_nothing_comes)
{
  run(" a = socket_read_string(\"host\", timeout=0.5)\n textmsg(\"empty: '\", str_cat(a, \"'\"))");
  ASSERT_TRUE(wait_for_end());
  EXPECT_TRUE(logged(controller, "empty: ''"));
}

TEST_F(ScriptSockets, cut_out_what_stands_between_prefix_and_suffix)
{
  run(" socket_send_string(\"go\\n\", \"host\")\n socket_send_line(\"\", \"host\")\n"
      " textmsg(\"cut: \", socket_read_string(\"host\", prefix=\"<\", suffix=\">\"))");
  ASSERT_NE(host.request(), "");
  ASSERT_TRUE(host.answer("noise<core>rest"));
  ASSERT_TRUE(wait_for_end());
  EXPECT_TRUE(logged(controller, "cut: core"));
}

TEST(ScriptSocket, answers_false_when_nobody_listens)
{
  SimulatedController controller(on_own_address());
  ASSERT_TRUE(
      controller.control({{"command", "run_script"},
                          {"script", "def test():\n r = socket_open(\"" + controller.address() +
                                         "\", 9)\n textmsg(\"opened: \", r)\n s = socket_send_line(\"x\")\n"
                                         " textmsg(\"sent: \", s)\nend\n"}})["ok"]);
  ASSERT_TRUE(wait_for_program(controller, "STOPPED"));
  EXPECT_TRUE(logged(controller, "opened: False"));
  EXPECT_TRUE(logged(controller, "sent: False"));
}

}  // namespace
}  // namespace ur_simulator::testing
