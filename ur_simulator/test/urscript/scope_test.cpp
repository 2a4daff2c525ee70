#include "script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

std::string global_after(const std::string & body, const std::string & name)
{
  ScriptRunner runner("def test():\n" + body + "\nend\n");
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
  return runner.global(name);
}

TEST(Scope, a_local_masks_the_global_of_its_name)
{
  EXPECT_EQ(global_after("global a = 0\n def f():\n local a = 1\n a = a + 1\n end\n f()", "a"), "0");
}

TEST(Scope, a_bare_name_means_the_global_if_there_is_one)
{
  EXPECT_EQ(global_after("global a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
}

TEST(Scope, nested_functions_follow_the_same_rule)
{
  EXPECT_EQ(
      global_after("global a = 0\n def f():\n local a = 1\n def g():\n a = 2\n end\n g()\n end\n f()", "a"),
      "2");
}

TEST(Scope, variables_of_the_first_level_are_global_whatever_their_qualifier)
{
  EXPECT_EQ(global_after("a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
  EXPECT_EQ(global_after("local a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
}

TEST(Scope, a_bare_name_without_a_global_stays_local)
{
  EXPECT_EQ(global_after("def f():\n b = 1\n return b\n end\n x = f()", "x"), "1");
  EXPECT_EQ(global_after("def f():\n b = 1\n end\n f()", "b"), "");
}

TEST(Scope, whether_there_is_a_global_shows_when_the_statement_runs)
{
  EXPECT_EQ(global_after("def f():\n a = 1\n return a\n end\n x = f()\n a = 5\n y = f()", "x"), "1");
  EXPECT_EQ(global_after("def f():\n a = 1\n return a\n end\n x = f()\n a = 5\n y = f()", "a"), "1");
}

TEST(Scope, a_parameter_masks_a_global)
{
  EXPECT_EQ(global_after("cmd = 5\n def f(cmd):\n cmd = cmd + 1\n return cmd\n end\n x = f(1)", "cmd"), "5");
}

TEST(Scope, a_function_may_call_what_is_defined_after_it)
{
  EXPECT_EQ(global_after("def f():\n return g()\n end\n def g():\n return 7\n end\n x = f()", "x"), "7");
}

TEST(Scope, a_global_can_be_declared_inside_a_nested_if)
{
  EXPECT_EQ(global_after("def f():\n if True:\n global handle = 3\n end\n end\n f()", "handle"), "3");
}

TEST(Scope, functions_are_visible_from_the_inside_out)
{
  EXPECT_EQ(global_after("def f():\n def g():\n return 2\n end\n return g()\n end\n def g():\n return 1\n "
                         "end\n x = f() * 10 + g()",
                         "x"),
            "21");
}

TEST(Scope, reading_a_variable_before_it_has_a_value_is_an_error)
{
  ScriptRunner runner("def test():\n def f():\n x = a\n end\n f()\n a = 1\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::failed);
  EXPECT_EQ(runner.machine->error().message, "The variable 'a' has no value");
  EXPECT_EQ(runner.machine->error().line, 3);
}

TEST(Scope, functions_with_a_value_of_a_builtins_name_replace_it)
{
  EXPECT_EQ(global_after("def sin(x):\n return 5\n end\n x = sin(0)", "x"), "5");
}

}  // namespace
}  // namespace ur_simulator::urscript
