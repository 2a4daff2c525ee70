#include "support/script_runner.hpp"
#include "urscript/compiler/code.hpp"

// Statements that extend a running program.

namespace ur_simulator::urscript {
namespace {

constexpr const char * programs[] = {
    "def p():\n  global a = 1\n  def f(x, y = 2):\n    b = x + y\n    return b\n  end\n  thread t():\n    a "
    "= f(1)\n  end\n  run t()\n  sync()\nend\n",
    "def p():\n  v = [1, 2, 3]\n  v[1] = 5\n  s = struct(m = 1)\n  s.m = s.m + v[0]\n  while s.m < 10:\n    "
    "s.m = s.m + 1\n  end\nend\n",
    "x = 1\nif x == 1:\n  textmsg(\"one\")\nend\n",
};

// Local names of the program, new names, and functions.
constexpr const char * statements[] = {"b = 7",
                                       "c = [1, 2]\nc[0] = 3",
                                       "def g(z): return z * 2 end",
                                       "d = g(c[0]) + b",
                                       "thread u(): sync() end\nrun u()",
                                       "textmsg(\"x\", d)"};

/// Instructions up to the storage of a variable, which may not change either.
bool same(const Instruction & left, const Instruction & right)
{
  return left.op == right.op && left.a == right.a && left.b == right.b;
}

TEST(ExtensionTest, TheCodeOfTheProgramKeepsItsPlace)
{
  const auto library = standard_library();
  for (const char * text : programs) {
    const auto program = compile(text, *library);
    ASSERT_TRUE(program) << text;
    ExtendedProgram extended(*program, *library);
    for (const char * statement : statements) {
      const Code before = extended.code();
      const auto function = extended.add(statement);
      ASSERT_TRUE(function) << statement << ": " << function.error().text();
      const Code & after = extended.code();
      ASSERT_LT(before.instructions.size(), after.instructions.size());
      EXPECT_TRUE(std::equal(before.instructions.begin(), before.instructions.end(),
                             after.instructions.begin(), same))
          << text << statement;
      for (std::size_t i = 0; i < before.functions.size(); ++i) {
        EXPECT_EQ(before.functions[i].entry, after.functions[i].entry);
        EXPECT_EQ(before.functions[i].locals, after.functions[i].locals);
      }
      EXPECT_TRUE(
          std::equal(before.global_names.begin(), before.global_names.end(), after.global_names.begin()));
      EXPECT_GE(*function, before.functions.size());
    }
  }
}

TEST(ExtensionTest, ErrorsNameTheLineOfTheStatements)
{
  const auto library = standard_library();
  const auto program = compile(programs[0], *library);
  ExtendedProgram extended(*program, *library);
  const auto unknown = extended.add("e = missing(1)");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().line, 1);
  EXPECT_EQ(unknown.error().undefined_name, "missing");
  EXPECT_FALSE(extended.add("if True:"));
  EXPECT_FALSE(extended.add("global new_one = 1"));
  EXPECT_TRUE(extended.add("global a = 2")) << "a global of the program";
  EXPECT_FALSE(extended.add("def f(x): return x end")) << "a function of the program";
}

/// Nothing of a rejected statement is left: neither its code nor its names.
TEST(ExtensionTest, StatementsThatDoNotCompileChangeNothing)
{
  const auto library = standard_library();
  const auto program = compile(programs[1], *library);
  ExtendedProgram extended(*program, *library);
  ASSERT_TRUE(extended.add("good = 1"));
  const Code before = extended.code();
  EXPECT_FALSE(extended.add("bad = 1\ndef h(): return struct(n = [2]) end\nw = missing(h())"));
  const Code & after = extended.code();
  EXPECT_EQ(before.instructions.size(), after.instructions.size());
  EXPECT_EQ(before.lines, after.lines);
  EXPECT_EQ(before.constants.size(), after.constants.size());
  EXPECT_EQ(before.functions.size(), after.functions.size());
  EXPECT_EQ(before.global_names, after.global_names);
  EXPECT_EQ(before.names, after.names);
  EXPECT_EQ(before.lvalues.size(), after.lvalues.size());
  EXPECT_EQ(extended.add("x = h()").error().undefined_name, "h");
  EXPECT_FALSE(extended.add("x = bad"));
  EXPECT_TRUE(extended.add("x = good"));
}

}  // namespace
}  // namespace ur_simulator::urscript
