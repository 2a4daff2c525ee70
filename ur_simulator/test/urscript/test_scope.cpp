#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

std::string global_after(const std::string & body, const std::string & name)
{
  ScriptRunner runner("def test():\n" + body + "\nend\n");
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
  return runner.global(name);
}

TEST(ScopeTest, ALocalMasksTheGlobalOfItsName)
{
  EXPECT_EQ(global_after("global a = 0\n def f():\n local a = 1\n a = a + 1\n end\n f()", "a"), "0");
}

TEST(ScopeTest, AnUnqualifiedNameRefersToTheGlobalIfItExists)
{
  EXPECT_EQ(global_after("global a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
}

TEST(ScopeTest, NestedFunctionsFollowTheSameRule)
{
  EXPECT_EQ(
      global_after("global a = 0\n def f():\n local a = 1\n def g():\n a = 2\n end\n g()\n end\n f()", "a"),
      "2");
}

TEST(ScopeTest, VariablesOfTheFirstLevelAreGlobalWhateverTheirQualifier)
{
  EXPECT_EQ(global_after("a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
  EXPECT_EQ(global_after("local a = 0\n def f():\n a = 1\n end\n f()", "a"), "1");
}

TEST(ScopeTest, AnUnqualifiedNameWithoutAGlobalIsLocal)
{
  EXPECT_EQ(global_after("def f():\n b = 1\n return b\n end\n x = f()", "x"), "1");
  EXPECT_EQ(global_after("def f():\n b = 1\n end\n f()", "b"), "");
}

TEST(ScopeTest, ExistenceOfAGlobalIsDeterminedAtRunTime)
{
  EXPECT_EQ(global_after("def f():\n a = 1\n return a\n end\n x = f()\n a = 5\n y = f()", "x"), "1");
  EXPECT_EQ(global_after("def f():\n a = 1\n return a\n end\n x = f()\n a = 5\n y = f()", "a"), "1");
}

TEST(ScopeTest, AParameterMasksAGlobal)
{
  EXPECT_EQ(global_after("cmd = 5\n def f(cmd):\n cmd = cmd + 1\n return cmd\n end\n x = f(1)", "cmd"), "5");
}

TEST(ScopeTest, AFunctionCanCallFunctionsDefinedLater)
{
  EXPECT_EQ(global_after("def f():\n return g()\n end\n def g():\n return 7\n end\n x = f()", "x"), "7");
}

TEST(ScopeTest, AGlobalCanBeDeclaredInsideANestedIf)
{
  EXPECT_EQ(global_after("def f():\n if True:\n global handle = 3\n end\n end\n f()", "handle"), "3");
}

TEST(ScopeTest, InnerFunctionsTakePrecedence)
{
  EXPECT_EQ(global_after("def f():\n def g():\n return 2\n end\n return g()\n end\n def g():\n return 1\n "
                         "end\n x = f() * 10 + g()",
                         "x"),
            "21");
}

TEST(ScopeTest, ReadingAVariableBeforeItHasAValueIsAnError)
{
  ScriptRunner runner("def test():\n def f():\n x = a\n end\n f()\n a = 1\n end");
  EXPECT_EQ(runner.finish(), MachineStatus::failed);
  EXPECT_EQ(runner.machine->error().message, "The variable 'a' has no value");
  EXPECT_EQ(runner.machine->error().line, 3);
}

TEST(ScopeTest, AFunctionReplacesABuiltinOfTheSameName)
{
  EXPECT_EQ(global_after("def sin(x):\n return 5\n end\n x = sin(0)", "x"), "5");
}

}  // namespace
}  // namespace ur_simulator::urscript
