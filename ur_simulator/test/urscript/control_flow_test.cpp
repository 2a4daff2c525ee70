#include "script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

TEST(ControlFlow, takes_the_first_branch_whose_condition_holds)
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

TEST(ControlFlow, loops_until_break_and_skips_on_continue)
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

TEST(ControlFlow, does_not_need_line_ends)
{
  ScriptRunner runner("def test(): a = 1 b = 2 if a < b: c = a + b end end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("c"), "3");
}

TEST(ControlFlow, an_expression_may_be_complete_only_on_the_next_line)
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

TEST(ControlFlow, calls_with_defaults_and_named_arguments)
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

TEST(ControlFlow, recursion_works_and_has_an_end)
{
  ScriptRunner runner(
      "def test():\n def f(n):\n if n < 2:\n return 1\n end\n return n * f(n - 1)\n end\n x = f(10)\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "3628800");

  ScriptRunner endless("def test():\n def f():\n f()\n end\n f()\n end");
  EXPECT_EQ(endless.finish(), MachineStatus::failed);
  EXPECT_NE(endless.machine->error().message.find("calls inside each other"), std::string::npos);
  EXPECT_EQ(endless.machine->error().line, 3);
}

TEST(ControlFlow, runs_several_definitions_and_statements_as_one_body)
{
  ScriptRunner runner("def one():\n return 1\nend\ndef two():\n return one() + 1\nend\nx = two()\n");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "2");
  EXPECT_EQ(runner.machine->program().name(), "");
}

TEST(ControlFlow, knows_the_name_and_kind_of_a_program)
{
  const auto library = standard_library();
  EXPECT_EQ(compile("def first():\nend\n", *library)->name(), "first");
  EXPECT_FALSE(compile("def first():\nend\n", *library)->secondary());
  EXPECT_TRUE(compile("sec second():\n textmsg(1)\nend\n", *library)->secondary());
}

TEST(ControlFlow, halt_ends_the_whole_program)
{
  ScriptRunner runner("def test():\n def f():\n halt\n end\n x = 1\n f()\n x = 2\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

TEST(ControlFlow, program_labels_of_polyscope_are_skipped)
{
  ScriptRunner runner("def test():\n $ 1 \"Robot Program\"\n $ 2 \"x=1\" \"noBreak\"\n x = 1\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "1");
}

}  // namespace
}  // namespace ur_simulator::urscript
