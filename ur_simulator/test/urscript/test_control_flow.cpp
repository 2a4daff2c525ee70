#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

TEST(ControlFlowTest, TakesTheFirstBranchWhoseConditionHolds)
{
  const std::string text = R"(def test():
    result = ""
    def pick(x):
      if x == 1:
        return "one"
      elif x == 2:
        return "two"
      else:
        return "many"
      end
    end
    result = pick(1) + pick(2) + pick(3)
  end
)";
  ScriptRunner runner(text);
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("result"), "onetwomany");
}

TEST(ControlFlowTest, LoopsUntilBreakAndSkipsOnContinue)
{
  ScriptRunner runner(R"(def test():
    i = 0
    sum = 0
    while True:
      i = i + 1
      if i % 2 == 0:
        continue
      end
      if i > 9:
        break
      end
      sum = sum + i
    end
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("sum"), "25");
}

TEST(ControlFlowTest, DoesNotNeedLineEnds)
{
  ScriptRunner runner("def test(): a = 1 b = 2 if a < b: c = a + b end end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("c"), "3");
}

TEST(ControlFlowTest, AnExpressionMayBeCompleteOnlyOnTheNextLine)
{
  ScriptRunner runner(R"(def test():
    global offset = # offset of the float registers
0    global other = # offset of the others
024    global third = 2
    def f():
      return
      other = 7
    end
    f()
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("offset"), "0");
  EXPECT_EQ(runner.global("other"), "24");
  EXPECT_EQ(runner.global("third"), "2");
}

TEST(ControlFlowTest, CallsWithDefaultsAndNamedArguments)
{
  ScriptRunner runner(R"(def test():
    def add(a = 1, b = a * 10):
      return a + b
    end
    x = add()
    y = add(2)
    z = add(b = 5)
    w = add(1, b = 2)
  end)");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "11");
  EXPECT_EQ(runner.global("y"), "22");
  EXPECT_EQ(runner.global("z"), "6");
  EXPECT_EQ(runner.global("w"), "3");
}

TEST(ControlFlowTest, RecursionWorksAndHasAnEnd)
{
  ScriptRunner runner(
      "def test():\n def f(n):\n if n < 2:\n return 1\n end\n return n * f(n - 1)\n end\n x = f(10)\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "3628800");

  ScriptRunner endless("def test():\n def f():\n f()\n end\n f()\n end");
  EXPECT_EQ(endless.finish(), MachineStatus::failed);
  EXPECT_NE(endless.machine->error().message.find("call depth exceeds"), std::string::npos);
  EXPECT_EQ(endless.machine->error().line, 3);
}

TEST(ControlFlowTest, RunsSeveralDefinitionsAndStatementsAsOneBody)
{
  ScriptRunner runner("def one():\n return 1\nend\ndef two():\n return one() + 1\nend\nx = two()\n");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "2");
  EXPECT_EQ(runner.machine->program().name(), "");
}

TEST(ControlFlowTest, ProvidesNameAndKindOfAProgram)
{
  const auto library = standard_library();
  EXPECT_EQ(compile("def first():\nend\n", *library)->name(), "first");
  EXPECT_FALSE(compile("def first():\nend\n", *library)->is_secondary());
  EXPECT_TRUE(compile("sec second():\n textmsg(1)\nend\n", *library)->is_secondary());
}

TEST(ControlFlowTest, HaltEndsTheWholeProgram)
{
  ScriptRunner runner("def test():\n def f():\n halt\n end\n x = 1\n f()\n x = 2\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(ControlFlowTest, ProgramLabelsOfPolyscopeAreSkipped)
{
  ScriptRunner runner("def test():\n $ 1 \"Robot Program\"\n $ 2 \"x=1\" \"noBreak\"\n x = 1\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(ControlFlowTest, AStringIsTrueUnlessItIsEmpty)
{
  EXPECT_EQ(evaluate("\"text\" and not \"\""), "True");
}

}  // namespace
}  // namespace ur_simulator::urscript
