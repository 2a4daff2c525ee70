#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

std::string after(const std::string & body, const std::string & name)
{
  ScriptRunner runner("def test():\n" + body + "\nend\n");
  if (runner.finish() == MachineStatus::failed) {
    return "line " + std::to_string(runner.machine->error().line) + ": " + runner.machine->error().message;
  }
  return runner.global(name);
}

TEST(ValueTest, AreCopiedByAssignment)
{
  EXPECT_EQ(after("a = [1, 2, 3]\n b = a\n b[0] = 9", "a"), "[1, 2, 3]");
  EXPECT_EQ(after("a = [1, 2, 3]\n b = a\n b[0] = 9", "b"), "[9, 2, 3]");
  EXPECT_EQ(after("a = p[1,2,3,4,5,6]\n def f(x):\n x[0] = 7\n return x\n end\n b = f(a)", "a"),
            "p[1, 2, 3, 4, 5, 6]");
  EXPECT_EQ(after("a = [[1,2],[3,4]]\n b = a\n b[1, 0] = 9", "a"), "[[1, 2], [3, 4]]");
}

TEST(ValueTest, PIsAVariableAndThePrefixOfAPose)
{
  EXPECT_EQ(after("p = p[1, 2, 3, 4, 5, 6]\n x = p[0] + p[5]", "x"), "7");
  EXPECT_EQ(after("p = [1, 2]\n p[1] = 5\n x = p[1]", "x"), "5");
}

TEST(ValueTest, RowsOfEqualLengthFormAMatrix)
{
  EXPECT_EQ(after("m = [[1, 2], [3, 4], [5, 6]]\n x = m[2, 0]", "x"), "5");
  EXPECT_EQ(after("m = [[1, 2], [3, 4]]\n x = m[1]", "x"), "[3, 4]");
  EXPECT_EQ(after("m = [[1, 2], [3, 4]]\n m[2, 0] = 1", "m"),
            "line 3: index 2 is out of range: the matrix has 2 elements");
}

TEST(ValueTest, ElementsOfElementsCanBeWritten)
{
  EXPECT_EQ(after("l = [p[0,0,0,0,0,0], p[1,1,1,1,1,1]]\n l[1][2] = 5", "l"),
            "[p[0, 0, 0, 0, 0, 0], p[1, 1, 5, 1, 1, 1]]");
}

TEST(ValueTest, StructuresHaveNamedMembers)
{
  EXPECT_EQ(after("s = struct(x = 1, label = \"a\")\n s.x = s.x + 1", "s"), "struct(x=2, label=\"a\")");
  EXPECT_EQ(after("s = struct(q = [1, 2])\n t = s\n t.q[0] = 5\n x = s.q[0] + t.q[0]", "x"), "6");
  EXPECT_EQ(after("s = struct(x = 1)\n y = s.z", "y"), "line 3: the struct has no member 'z'");
}

TEST(ValueTest, ListsHaveMethods)
{
  EXPECT_EQ(after("l = [1]\n l.append(2)\n l.insert(0, 0)\n l.extend([3, 4])", "l"), "[0, 1, 2, 3, 4]");
  EXPECT_EQ(after("l = [1, 2, 3]\n x = l.pop()\n l.remove(0)\n x = x + l.length()", "x"), "4");
  EXPECT_EQ(after("l = [1, 2, 3, 4].slice(1, 3)", "l"), "[2, 3]");
  EXPECT_EQ(after("l = [1]\n l.clear()\n l.pop()", "l"), "line 4: pop() of an empty list");
  EXPECT_EQ(after("l = [1]\n l.sort()", "l"), "line 3: a list has no method 'sort'");
}

TEST(ValueTest, ErrorForIndicesOutOfRangeContainsTheLine)
{
  EXPECT_EQ(after("l = [1, 2]\n x = l[2]", "x"), "line 3: index 2 is out of range: the list has 2 elements");
  EXPECT_EQ(after("l = [1, 2]\n x = l[-1]", "x"),
            "line 3: index -1 is out of range: the list has 2 elements");
  EXPECT_EQ(after("l = [1, 2]\n x = l[0.5]", "x"),
            "line 3: Type error: the index of a list must be an int, not float");
  EXPECT_EQ(after("q = p[0,0,0,0,0,0]\n q[0] = \"a\"", "q"),
            "line 3: Type error: an element of a pose is a number, not string");
}

TEST(ValueTest, SizeIsBounded)
{
  EXPECT_NE(after("l = [1]\n while True:\n l.extend(l)\n end", "l").find("must have at most"),
            std::string::npos);
  EXPECT_NE(after("s = \"ab\"\n while True:\n s = s + s\n end", "s").find("longer than"), std::string::npos);
  EXPECT_NE(after("l = [struct(a=1)]\n while True:\n l = [l, l]\n end", "l").find("must have at most"),
            std::string::npos);
}

}  // namespace
}  // namespace ur_simulator::urscript
