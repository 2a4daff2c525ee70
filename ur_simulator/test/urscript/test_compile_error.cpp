#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

void expect_error(const std::string & text, int line, const std::string & message)
{
  const CompileError error = compile_error(text);
  EXPECT_EQ(error.line, line) << error.text();
  EXPECT_NE(error.message.find(message), std::string::npos) << error.text();
}

TEST(CompileErrorTest, ContainsUnknownFunctionsAndVariables)
{
  expect_error("def test():\n  movej_fast([1])\nend", 2, "The function 'movej_fast' is not defined");
  expect_error("def test():\n  x = y\nend", 2, "The variable 'y' is not defined");
  expect_error("def test():\n  x = run nothing()\nend", 2, "The thread 'nothing' is not defined");
  expect_error("def test():\n  q[0] = 1\nend", 2, "The variable 'q' is not defined");
}

TEST(CompileErrorTest, ChecksArguments)
{
  expect_error("def test():\n def f(a):\n end\n f()\nend", 4, "needs the argument 'a'");
  expect_error("def test():\n def f(a):\n end\n f(1, 2)\nend", 4, "takes 1 arguments, 2 are given");
  expect_error("def test():\n def f(a):\n end\n f(b = 2)\nend", 4, "has no parameter 'b'");
  expect_error("def test():\n def f(a):\n end\n f(1, a = 2)\nend", 4, "is given twice");
  expect_error("def test():\n def f(a, b):\n end\n f(a = 1, 2)\nend", 4,
               "positional argument follows a named one");
  expect_error("sleep()", 1, "needs the argument 't'");
}

TEST(CompileErrorTest, ContainsTheLineOfASyntaxError)
{
  EXPECT_EQ(compile_error("def test():\r\n  if True\r\n    x = 1\r\n  end\r\nend\r\n").source_line,
            "    x = 1");
  EXPECT_EQ(compile_error("def test():\n  x = 1\n").source_line, "");
  EXPECT_EQ(compile_error("x = (").source_line, "x = (");
  EXPECT_EQ(compile_error("x = y").source_line, std::nullopt);
}

TEST(CompileErrorTest, ContainsThePositionOfASyntaxError)
{
  const CompileError error = compile_error("def test():\n  if True\n    x = 1\n  end\nend\n");
  EXPECT_EQ(error.line, 3);
  EXPECT_EQ(error.column, 5);
  EXPECT_EQ(error.message, "expected ':', found 'x'");
  EXPECT_EQ(error.text(), "Compile error on line 3, column 5: expected ':', found 'x'");
  expect_error("def test():\n  x = 1\n", 3, "an 'end' is missing");
  expect_error("def test():\n  x = (1 + \nend\n", 3, "expected a value, found 'end'");
  expect_error("def test():\n  x = \"abc\nend\n", 2, "not closed");
  expect_error("def test():\n  x = 1 ? 2\nend\n", 2, "unexpected character");
  expect_error("def test():\n  x\nend\n", 2, "without effect");
  expect_error("def test():\n  f() = 1\nend\n", 2, "can be assigned to");
  expect_error("def test():\n  x = p[1, 2, 3]\nend\n", 2, "a pose has six elements, not 3");
  expect_error("break\n", 1, "outside of a while loop");
  expect_error("for i in [1]:\nend\n", 1, "'for' is reserved");
  expect_error("def test(a):\nend\n", 1, "takes no parameters");
}

TEST(CompileErrorTest, LimitsNestingAndSize)
{
  expect_error("x = " + std::string(100000, '(') + "1", 1, "nested deeper");
  expect_error("x = " + std::string(100000, '-') + "1", 1, "nested deeper");
  expect_error("x = [" + std::string(100000, '['), 1, "nested deeper");
  std::string blocks;
  std::string links = "x = 1 x";
  for (int i = 0; i < 1000; ++i) {
    blocks += "while True: ";
    links += "[0]";
  }
  expect_error(blocks, 1, "nested deeper");
  expect_error(links + " = 1", 1, "nested deeper");
  CompileLimits limits;
  limits.text_bytes = 10;
  EXPECT_FALSE(compile("x = 1 x = 2 x = 3", *standard_library(), limits).has_value());
  limits = {};
  limits.nodes = 10;
  EXPECT_FALSE(compile("x = 1+1+1+1+1+1+1+1+1+1+1+1+1+1", *standard_library(), limits).has_value());
}

TEST(CompileErrorTest, LongChainsDoNotCountAsNesting)
{
  std::string text = "x = 0";
  for (int i = 0; i < 20000; ++i) {
    text += " + 1";
  }
  ScriptRunner runner(text);
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.global("x"), "20000");
}

}  // namespace
}  // namespace ur_simulator::urscript
