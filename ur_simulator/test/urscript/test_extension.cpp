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
    auto program = compile(text, *library);
    ASSERT_TRUE(program) << text;
    for (const char * statement : statements) {
      const auto extended = extend(*program, statement, *library);
      ASSERT_TRUE(extended) << statement << ": " << extended.error().text();
      const Code & before = program->code();
      const Code & after = extended->program.code();
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
      EXPECT_GE(extended->function, before.functions.size());
      program = extended->program;
    }
  }
}

TEST(ExtensionTest, ErrorsNameTheLineOfTheStatements)
{
  const auto library = standard_library();
  const auto program = compile(programs[0], *library);
  const auto unknown = extend(*program, "e = missing(1)", *library);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().line, 1);
  EXPECT_EQ(unknown.error().undefined_name, "missing");
  EXPECT_FALSE(extend(*program, "if True:", *library));
  EXPECT_FALSE(extend(*program, "global new_one = 1", *library));
  EXPECT_TRUE(extend(*program, "global a = 2", *library)) << "a global of the program";
  EXPECT_FALSE(extend(*program, "def f(x): return x end", *library)) << "a function of the program";
}

}  // namespace
}  // namespace ur_simulator::urscript
