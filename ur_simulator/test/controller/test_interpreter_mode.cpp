#include <fmt/format.h>

#include "support/simulator_test.hpp"
#include "support/tcp_client.hpp"

// Interpreter mode over its socket: UR, script manual, "Interpreter Mode".

namespace ur_simulator::testing {
namespace {

class InterpreterModeTest : public ::testing::Test {
 protected:
  SimulatedController controller{with_unique_address()};
  TcpClient client{controller.address(), controller.ports().interpreter};

  void run(const std::string & script)
  {
    controller.control({{"command", "run_script"}, {"script", script}});
    ASSERT_TRUE(controller.wait_until(
        [](const json & state) { return state["program"]["state"] == "PLAYING"; }, seconds(10)));
  }
  /// Runs a program that enters interpreter mode and waits until it is active.
  void enter(const std::string & arguments = "")
  {
    run("def host():\n  global offset = 10\n  def twice(x):\n    return 2 * x\n  end\n  "
        "set_standard_digital_out(7, True)\n"
        "  interpreter_mode(" +
        arguments + ")\n  set_standard_digital_out(6, True)\n  while True:\n    sync()\n  end\nend\n");
    ASSERT_TRUE(wait_for_output(7));
    ASSERT_EQ(ask("textmsg(\"active\")"), "ack: 1: textmsg(\"active\")");
  }
  std::string ask(const std::string & line)
  {
    client.send(line + "\n");
    return client.receive_line();
  }
  bool wait_for_output(int number)
  {
    return controller.wait_until(
        [number](const json & state) {
          return (state["io"]["digital_outputs"].get<unsigned>() >> number) % 2 == 1;
        },
        seconds(20));
  }
  bool wait_for_answer(const std::string & request, const std::string & answer)
  {
    const double end = controller.state()["timestamp"].get<double>() + 20.0;
    while (ask(request) != answer) {
      if (controller.state()["timestamp"].get<double>() > end) {
        return false;
      }
    }
    return true;
  }
};

TEST_F(InterpreterModeTest, ExecutesStatementsInOrder)
{
  enter();
  EXPECT_EQ(ask("x = twice(offset) + 1"), "ack: 2: x = twice(offset) + 1");
  EXPECT_EQ(ask("if x == 21: set_standard_digital_out(1, True) end"),
            "ack: 3: if x == 21: set_standard_digital_out(1, True) end");
  EXPECT_TRUE(wait_for_output(1));
  EXPECT_TRUE(wait_for_answer("statelastexecuted", "state: 3: statelastexecuted"));
  EXPECT_EQ(ask("statelastinterpreted"), "state: 3: statelastinterpreted");
  EXPECT_EQ(ask("stateunexecuted"), "state: 0: stateunexecuted");
}

TEST_F(InterpreterModeTest, ADefinitionOnOneLineCanBeCalledAndReplaced)
{
  enter();
  EXPECT_EQ(ask("def light(n): set_standard_digital_out(n, True) textmsg(n) end").substr(0, 7), "ack: 2:");
  EXPECT_EQ(ask("light(2)"), "ack: 3: light(2)");
  EXPECT_TRUE(wait_for_output(2));
  EXPECT_EQ(ask("def light(n): set_standard_digital_out(n + 1, True) end").substr(0, 7), "ack: 4:");
  EXPECT_EQ(ask("light(2)"), "ack: 5: light(2)");
  EXPECT_TRUE(wait_for_output(3));
}

TEST_F(InterpreterModeTest, DiscardsWhatCannotBeExecuted)
{
  EXPECT_EQ(ask("set_digital_out(0, True)"), "discard: no program is running: set_digital_out(0, True)");
  enter();
  EXPECT_NE(ask("unknown_function(1)").find("discard: Compile error"), std::string::npos);
  EXPECT_NE(ask("movej(").find("discard: Compile error"), std::string::npos);
  EXPECT_NE(ask("global new_one = 1").find("cannot be declared in interpreter mode"), std::string::npos);
  EXPECT_NE(ask("def twice(x): return x end").find("already a function of the program"), std::string::npos);
  EXPECT_EQ(ask("offset = 5"), "ack: 2: offset = 5") << "discarded lines have no number";
}

TEST_F(InterpreterModeTest, ARunTimeErrorEndsTheProgram)
{
  enter();
  EXPECT_EQ(ask("y = [1, 2][7]"), "ack: 2: y = [1, 2][7]");
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["program"]["state"] == "STOPPED"; },
                                    seconds(10)));
  EXPECT_EQ(ask("sync()"), "discard: no program is running: sync()");
}

TEST_F(InterpreterModeTest, NestedInterpreterModeIsARunTimeError)
{
  enter();
  EXPECT_EQ(ask("interpreter_mode()"), "ack: 2: interpreter_mode()");
  EXPECT_TRUE(controller.wait_until([](const json & state) { return state["program"]["state"] == "STOPPED"; },
                                    seconds(10)));
}

TEST_F(InterpreterModeTest, EndsAndRemovesTheStatements)
{
  enter();
  ask("thread blink(): while True: set_standard_digital_out(0, True) sync() end end");
  ask("handle = run blink()");
  EXPECT_TRUE(wait_for_output(0));
  EXPECT_EQ(ask("end_interpreter()"), "ack: 4: end_interpreter()");
  EXPECT_TRUE(wait_for_output(6)) << "interpreter_mode() returns";
  EXPECT_EQ(ask("statelastcleared"), "state: 4: statelastcleared");
  controller.control(
      {{"command", "run_script"}, {"script", "sec off():\n  set_standard_digital_out(0, False)\nend\n"}});
  const auto output_0 = [](const json & state) { return state["io"]["digital_outputs"].get<unsigned>() % 2; };
  ASSERT_TRUE(controller.wait_until([&](const json & state) { return output_0(state) == 0; }, seconds(10)));
  const double begin = controller.state()["timestamp"];
  EXPECT_TRUE(controller.wait_until(
      [&](const json & state) {
        EXPECT_EQ(output_0(state), 0U) << "the thread runs after the end of the mode";
        return state["timestamp"].get<double>() > begin + 0.1;
      },
      seconds(10)));
}

TEST_F(InterpreterModeTest, StatementsBeforeTheModeAreQueuedAndCleared)
{
  run("def late():\n  while get_standard_digital_in(0) == False:\n    sync()\n  end\n  "
      "interpreter_mode()\nend\n");
  client.send("set_standard_digital_out(1, True)\n");
  EXPECT_EQ(ask("stateunexecuted"), "state: 1: stateunexecuted");
  controller.control({{"command", "set_digital_input"}, {"number", 0}, {"value", true}});
  EXPECT_EQ(client.receive_line(),
            "discard: cleared when interpreter mode was entered: set_standard_digital_out(1, True)");
}

TEST_F(InterpreterModeTest, QueuedStatementsAreExecutedIfTheQueueIsNotCleared)
{
  run("def late():\n  while get_standard_digital_in(0) == False:\n    sync()\n  end\n"
      "  interpreter_mode(clearQueueOnEnter = False)\nend\n");
  client.send("set_standard_digital_out(1, True)\n");
  EXPECT_EQ(ask("stateunexecuted"), "state: 1: stateunexecuted");
  controller.control({{"command", "set_digital_input"}, {"number", 0}, {"value", true}});
  EXPECT_EQ(client.receive_line(), "ack: 1: set_standard_digital_out(1, True)");
  EXPECT_TRUE(wait_for_output(1));
}

TEST_F(InterpreterModeTest, StatementsAfterAClearWaitForIt)
{
  enter();
  ask("v = 1");
  client.send("sleep(0.2)\nclear_interpreter()\nset_standard_digital_out(v, True)\nw = 2\n");
  EXPECT_EQ(client.receive_line(), "ack: 3: sleep(0.2)");
  EXPECT_EQ(client.receive_line(), "ack: 4: clear_interpreter()");
  EXPECT_NE(client.receive_line().find("discard: Compile error"), std::string::npos) << "v was removed";
  EXPECT_EQ(client.receive_line(), "ack: 5: w = 2");
  EXPECT_EQ(ask("statelastcleared"), "state: 4: statelastcleared");
}

TEST_F(InterpreterModeTest, TheProgramDoesNotSeeVariablesOfStatements)
{
  run("def host():\n  def count():\n    i = 1\n    i = i + 1\n    return i\n  end\n  "
      "set_standard_digital_out(7, True)\n"
      "  interpreter_mode()\nend\n");
  ASSERT_TRUE(wait_for_output(7));
  ask("i = 40");
  ask("n = count()");
  ask("if i == 40 and n == 2: set_standard_digital_out(1, True) end");
  EXPECT_TRUE(wait_for_output(1));
}

TEST_F(InterpreterModeTest, SkipsTheBuffer)
{
  enter();
  client.send("sleep(0.5)\nset_standard_digital_out(1, True)\nset_standard_digital_out(2, True)\n");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(client.receive_line().substr(0, 4), "ack:");
  }
  ASSERT_TRUE(wait_for_answer("statelastexecuted", "state: 2: statelastexecuted"));
  EXPECT_EQ(ask("stateunexecuted"), "state: 2: stateunexecuted");
  EXPECT_EQ(ask("skipbuffer"), "ack: 4: skipbuffer");
  EXPECT_EQ(ask("stateunexecuted"), "state: 0: stateunexecuted");
  EXPECT_EQ(ask("set_standard_digital_out(3, True)").substr(0, 6), "ack: 5");
  ASSERT_TRUE(wait_for_output(3));
  EXPECT_EQ(controller.state()["io"]["digital_outputs"].get<unsigned>() & 0b1110U, 0b1000U);
}

TEST_F(InterpreterModeTest, AbortsAMotionAndGoesOn)
{
  enter();
  ask("q = get_actual_joint_positions()");
  ask("movej([q[0] + 2, q[1], q[2], q[3], q[4], q[5]], a = 1, v = 0.5)");
  ask("set_standard_digital_out(1, True)");
  ASSERT_TRUE(controller.wait_until(
      [](const json & state) { return state["target"]["velocity"][0].get<double>() > 0.4; }, seconds(20)));
  ask("abort");
  ASSERT_TRUE(wait_for_output(1));
  const json state = controller.state();
  EXPECT_EQ(state["safety_mode"], "NORMAL");
  EXPECT_NEAR(state["target"]["velocity"][0].get<double>(), 0.0, 1e-9)
      << "the next statement waits for the stop";
  EXPECT_EQ(state["program"]["state"], "PLAYING");
}

TEST_F(InterpreterModeTest, TheEndOfTheProgramDiscardsTheQueue)
{
  run("def no_mode():\n  while True:\n    sync()\n  end\nend\n");
  client.send("x = 1\n");
  EXPECT_EQ(ask("stateunexecuted"), "state: 1: stateunexecuted");
  controller.control({{"command", "stop_program"}});
  EXPECT_EQ(client.receive_line(), "discard: the program has ended: x = 1");
}

TEST_F(InterpreterModeTest, InterpretsManyStatementsThatCameAtOnce)
{
  constexpr int count = 10000;
  enter();
  std::string lines;
  for (int i = 0; i < count; ++i) {
    lines += fmt::format("v{} = {}\n", i % 100, i);
  }
  client.send(lines);
  for (int i = 0; i < count; ++i) {
    ASSERT_EQ(client.receive_line(), fmt::format("ack: {}: v{} = {}", i + 2, i % 100, i));
  }
}

TEST_F(InterpreterModeTest, TheSizeOfTheQueueIsLimited)
{
  run("def no_mode():\n  while True:\n    sync()\n  end\nend\n");
  const std::string line = "textmsg(\"" + std::string(60000, 'x') + "\")";
  for (int i = 0; i < 69; ++i) {
    client.send(line + "\n");
  }
  client.send(line + "\n");
  EXPECT_EQ(client.receive_line().substr(0, 45), "discard: too many statements are queued: text");
}

TEST(InterpreterModeVersionTest, OlderVersionsHaveNoInterpreterMode)
{
  SimulatorOptions options;
  options.polyscope_version = "5.9";
  SimulatedController controller(with_unique_address(options));
  EXPECT_THROW(TcpClient(controller.address(), controller.ports().interpreter), std::exception);
}

}  // namespace
}  // namespace ur_simulator::testing
