#include <gtest/gtest.h>

#include <string>

#include "script/program.hpp"

namespace ur_ros_rtde::script {
namespace {

ProgramOptions marks(bool secondary = false)
{
  return {secondary, "BEGIN", "END", {}};
}

std::string made(std::string_view script, const ProgramOptions & options = marks())
{
  const auto program = make_program(script, options);
  return program ? program->text.text()
                 : std::to_string(program.error().line) + ": " + program.error().message;
}

TEST(CompleteProgramTest, WritesMarkersAtBeginAndEnd)
{
  EXPECT_EQ(made("def f():\n  sync()\nend\n"),
            "def f():\n  textmsg(\"BEGIN\")\n\n  sync()\n  textmsg(\"END\")\nend\n");
}

TEST(CompleteProgramTest, KeepsNameAndDefaultArguments)
{
  const auto program = make_program("# mine\ndef f(a = [1, 2], b=p[0,0,0,0,0,0]):\nsync()\nend", marks());
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->name, "f");
  EXPECT_EQ(program->text.text().substr(0, 47), "# mine\ndef f(a = [1, 2], b=p[0,0,0,0,0,0]):\n  t");
}

TEST(CompleteProgramTest, WritesTheEndMarkerBeforeEachExit)
{
  const std::string text = made(
      "def f():\n"
      "  def g():\n    return 1\n  end\n"
      "  thread t():\n    halt\n  end\n"
      "  if g() == 1: return end\n"
      "  return 2\n"
      "end");
  EXPECT_EQ(text,
            "def f():\n  textmsg(\"BEGIN\")\n\n"
            "  def g():\n    return 1\n  end\n"
            "  thread t():\n    \n  textmsg(\"END\")\nhalt\n  end\n"
            "  if g() == 1: \n  textmsg(\"END\")\nreturn end\n"
            "  \n  textmsg(\"END\")\nreturn 2\n"
            "  textmsg(\"END\")\nend\n");
}

TEST(CompleteProgramTest, MapsLinesToTheOriginal)
{
  const auto program = make_program("\ndef f():\n  sync()\n  return 1\nend", {false, "B", "E", "  setup()"});
  ASSERT_TRUE(program);
  // 1 "", 2 def, 3 B, 4 setup, 5 rest of the head's line, 6 sync, 7 "  ", 8 E, 9 return, 10 E, 11 end
  for (const auto & [composed, original] :
       {std::pair{2, 2}, {3, 0}, {4, 0}, {5, 2}, {6, 3}, {8, 0}, {9, 4}, {11, 5}, {99, 0}, {0, 0}}) {
    EXPECT_EQ(program->text.origin(composed).line, original) << "line " << composed;
  }
}

TEST(ProgramBodyTest, IsWrappedInAProgram)
{
  EXPECT_EQ(made("sync()"),
            "def ur_ros_rtde_script():\n  textmsg(\"BEGIN\")\nsync()\n  textmsg(\"END\")\nend\n");
  EXPECT_EQ(made("sync()", marks(true)).substr(0, 27), "sec ur_ros_rtde_script():\n ");
  EXPECT_EQ(make_program("\n\nx = 1\n", marks())->text.origin(5).line, 3);
}

TEST(ProgramBodyTest, MayDefineFunctionsAndThreads)
{
  const std::string text = made("def f():\n  return 1\nend\nthread t():\n  sync()\nend\nx = f()\nreturn x");
  EXPECT_NE(text.find("x = f()\n  textmsg(\"END\")\nreturn x\n"), std::string::npos) << text;
  EXPECT_NE(text.find("def f():\n  return 1\nend"), std::string::npos) << text;
}

TEST(ScriptScanTest, IgnoresCommentsStringsAndLabels)
{
  EXPECT_EQ(made("# if\nx = \"def ( end\" # while\n$ 2 \"end\"\ny = 'if ['\n").substr(0, 4), "def ");
}

struct Wrong {
  const char * script;
  const char * complaint;
};

class InvalidScriptTest : public testing::TestWithParam<Wrong> {};

TEST_P(InvalidScriptTest, IsRejectedWithItsLine)
{
  const auto program = make_program(GetParam().script, marks());
  ASSERT_FALSE(program);
  const std::string complaint = std::to_string(program.error().line) + ": " + program.error().message;
  EXPECT_EQ(complaint.find(GetParam().complaint), 0U) << complaint;
}

INSTANTIATE_TEST_SUITE_P(
    Scripts, InvalidScriptTest,
    testing::Values(Wrong{"", "0: the script is empty"}, Wrong{"# only\n\n", "0: the script is empty"},
                    Wrong{"def f():\n  if True:\n    sync()\nend", "1: the `def` has no `end`"},
                    Wrong{"x = 1\nwhile x < 2:\n  sync()\n", "2: the `while` has no `end`"},
                    Wrong{"sync()\nend\n", "2: this `end` has no block"},
                    Wrong{"\nmovej([0, 1, 2\nend", "2: '[' is not closed"},
                    Wrong{"sync(\nif True:\nend", "1: '(' is not closed"},
                    Wrong{"sync())", "1: ')' has no opening bracket"},
                    Wrong{"x = [1, 2)", "1: ')' has no opening bracket"},
                    Wrong{"sync()\ntextmsg(\"a)\n", "2: a string is not closed"},
                    Wrong{"sync()\n\x01", "2: character code 1 is not allowed"},
                    Wrong{"sec f():\n sync()\nend", "1: a `sec` program runs beside"},
                    Wrong{"def f():\nend\ndef g():\nend", "0: the script defines functions and calls none"},
                    Wrong{"def f:\n  sync()\nend", "1: a program begins with `def name():`"}));

TEST(InvalidScriptTest, RejectsTheWrongKindOfProgram)
{
  EXPECT_EQ(made("def f():\n sync()\nend", marks(true)),
            "1: a secondary program begins with `sec`, not with `def`");
}

TEST(InvalidScriptTest, RejectsMoreThanOneMegabyte)
{
  EXPECT_NE(made(std::string(1'100'000, ' ')).find("1100000 bytes"), std::string::npos);
}

}  // namespace
}  // namespace ur_ros_rtde::script
