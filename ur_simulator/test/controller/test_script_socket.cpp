#include "support/simulator_test.hpp"
#include "support/single_reply_server.hpp"

namespace ur_simulator::testing {
namespace {

class ScriptSocketTest : public SimulatorTest {
 protected:
  SingleReplyServer host{controller.address()};

  void run_script(const std::string & body)
  {
    const std::string open = " global opened = socket_open(\"" + controller.address() + "\", " +
                             std::to_string(host.port()) + ", \"host\")\n";
    const json reply = controller.control(
        {{"command", "run_script"}, {"script", "def test():\n" + open + body + "\nend\n"}});
    ASSERT_TRUE(reply["ok"]) << reply.dump();
  }
  bool wait_for_program_end() { return wait_for_program_state(controller, "STOPPED"); }
};

TEST_F(ScriptSocketTest, ExchangesLines)
{
  run_script(
      " socket_send_line(\"how are you\", \"host\")\n answer = socket_read_line(\"host\")\n"
      " textmsg(\"heard: \", answer)\n socket_close(\"host\")");
  EXPECT_EQ(host.receive_request(), "how are you\n");
  ASSERT_TRUE(host.send_reply("fine\r\n"));
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "heard: fine"));
}

TEST_F(ScriptSocketTest, ReadsNumbersAsTextAndBytes)
{
  run_script(
      " socket_send_line(\"go\", \"host\")\n"
      " a = socket_read_ascii_float(2, \"host\")\n textmsg(\"floats: \", a)\n"
      " b = socket_read_binary_integer(1, \"host\")\n textmsg(\"integers: \", b)\n"
      " c = socket_read_byte_list(2, \"host\")\n textmsg(\"bytes: \", c)");
  EXPECT_EQ(host.receive_request(), "go\n");
  ASSERT_TRUE(host.send_reply(std::string("(1.5, -2)\0\0\1\2\7\x9", 15)));
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "floats: [2, 1.5, -2]"));
  EXPECT_TRUE(log_contains(controller, "integers: [1, 258]"));
  EXPECT_TRUE(log_contains(controller, "bytes: [2, 7, 9]"));
}

TEST_F(ScriptSocketTest, ReadTimesOut)
{
  run_script(" a = socket_read_string(\"host\", timeout=0.5)\n textmsg(\"empty: '\", str_cat(a, \"'\"))");
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "empty: ''"));
}

TEST_F(ScriptSocketTest, ReadsStringBetweenPrefixAndSuffix)
{
  run_script(
      " socket_send_string(\"go\\n\", \"host\")\n socket_send_line(\"\", \"host\")\n"
      " textmsg(\"cut: \", socket_read_string(\"host\", prefix=\"<\", suffix=\">\"))");
  ASSERT_NE(host.receive_request(), "");
  ASSERT_TRUE(host.send_reply("noise<core>rest"));
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "cut: core"));
}

TEST_F(ScriptSocketTest, IsClosedWhenTheProgramEnds)
{
  run_script(" socket_send_line(\"go\", \"host\")");
  EXPECT_EQ(host.receive_request(), "go\n");
  EXPECT_TRUE(host.wait_for_close());
}

TEST_F(ScriptSocketTest, IsClosedWhenTheProgramIsStopped)
{
  run_script(" socket_send_line(\"go\", \"host\")\n sleep(1000)");
  EXPECT_EQ(host.receive_request(), "go\n");
  ASSERT_TRUE(controller.control({{"command", "stop_program"}})["ok"]);
  EXPECT_TRUE(host.wait_for_close());
}

TEST_F(ScriptSocketTest, IsNotClosedByASecondaryProgram)
{
  run_script(" socket_send_line(\"go\", \"host\")\n textmsg(\"heard: \", socket_read_line(\"host\", 0))");
  EXPECT_EQ(host.receive_request(), "go\n");
  ASSERT_TRUE(
      controller.control({{"command", "run_script"},
                          {"script", "sec s():\n socket_close(\"host\")\n textmsg(\"done\")\nend\n"}})["ok"]);
  ASSERT_TRUE(wait_for_log(controller, "done"));
  ASSERT_TRUE(host.send_reply("fine\n"));
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "heard: fine"));
}

// A public client sets the speed slider like this.
TEST_F(ScriptSocketTest, ASecondaryProgramMayOpenASocket)
{
  const json reply = controller.control(
      {{"command", "run_script"},
       {"script", "sec set_speed():\n  socket_open(\"" + controller.address() +
                      "\", 30003)\n  socket_send_line(\"set speed 0.5\")\n  socket_close()\nend\n"}});
  ASSERT_TRUE(reply["ok"]) << reply.dump();
  EXPECT_TRUE(
      controller.wait_until([](const json & state) { return state["speed_slider"] == 0.5; }, seconds(10)));
}

TEST_F(ScriptSocketTest, ASecondaryProgramDoesNotWaitForASlowHost)
{
  const json reply = controller.control(
      {{"command", "run_script"},
       {"script", "sec ask():\n  socket_open(\"" + controller.address() + "\", " +
                      std::to_string(host.port()) + ")\n  socket_read_line()\n  textmsg(\"never\")\nend\n"}});
  ASSERT_TRUE(reply["ok"]) << reply.dump();
  EXPECT_TRUE(
      wait_for_log(controller, "secondary program 'ask' failed in line 3: Runtime is too much behind"));
  EXPECT_FALSE(log_contains(controller, "never"));
}

TEST_F(ScriptSocketTest, SlowsDownAHostThatSendsFasterThanTheProgramReads)
{
  run_script(
      " socket_send_line(\"go\", \"host\")\n sleep(0.1)\n n = 0\n"
      " while n < 3072 and str_len(socket_read_line(\"host\", 5)) == 1023:\n n = n + 1\n end\n"
      " textmsg(\"lines: \", n)");
  EXPECT_EQ(host.receive_request(), "go\n");
  std::string lines;
  for (int i = 0; i < 3072; ++i) {
    lines += std::string(1023, 'x') + '\n';
  }
  ASSERT_TRUE(host.send_reply(lines));
  ASSERT_TRUE(wait_for_program_end());
  EXPECT_TRUE(log_contains(controller, "lines: 3072"));
}

TEST(ScriptSocketConnectTest, OpenReturnsFalseIfConnectionIsRefused)
{
  SimulatedController controller(with_unique_address());
  ASSERT_TRUE(
      controller.control({{"command", "run_script"},
                          {"script", "def test():\n r = socket_open(\"" + controller.address() +
                                         "\", 9)\n textmsg(\"opened: \", r)\n s = socket_send_line(\"x\")\n"
                                         " textmsg(\"sent: \", s)\nend\n"}})["ok"]);
  ASSERT_TRUE(wait_for_program_state(controller, "STOPPED"));
  EXPECT_TRUE(log_contains(controller, "opened: False"));
  EXPECT_TRUE(log_contains(controller, "sent: False"));
}

}  // namespace
}  // namespace ur_simulator::testing
