#include <cmath>

#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

double number(const std::string & expression)
{
  ScriptRunner runner("def test():\n result = " + expression + "\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
  const Value * value = runner.machine->global("result");
  return value == nullptr ? NAN : value->number().value_or(NAN);
}

Vector6 six(const std::string & expression)
{
  ScriptRunner runner("def test():\n result = " + expression + "\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished) << runner.machine->error().message;
  const Value * value = runner.machine->global("result");
  return value == nullptr ? Vector6::Constant(NAN) : value->vector6().value_or(Vector6::Constant(NAN));
}

void expect_near(const Vector6 & actual, const Vector6 & expected)
{
  EXPECT_LT((actual - expected).norm(), 1e-9) << actual.transpose();
}

Vector6 vector(double a, double b, double c, double d, double e, double f)
{
  Vector6 result;
  result << a, b, c, d, e, f;
  return result;
}

TEST(MathTest, ComputesFunctionsOfTheUrmathModule)
{
  EXPECT_DOUBLE_EQ(number("sin(1) * sin(1) + cos(1) * cos(1)"), 1.0);
  EXPECT_DOUBLE_EQ(number("atan2(1, 2)"), std::atan2(1.0, 2.0));
  EXPECT_DOUBLE_EQ(number("d2r(180)"), M_PI);
  EXPECT_DOUBLE_EQ(number("r2d(3.141592653589793)"), 180.0);
  EXPECT_DOUBLE_EQ(number("pow(2, 10)"), 1024.0);
  EXPECT_DOUBLE_EQ(number("log(2, 8)"), 3.0);
  EXPECT_DOUBLE_EQ(number("norm([3, 4])"), 5.0);
  EXPECT_DOUBLE_EQ(number("norm(-5.5)"), 5.5);
  EXPECT_EQ(evaluate("[1, 2, 3][norm(-2)]"), "3");  // an int
  EXPECT_EQ(evaluate("ceil(1.1)"), "2");
  EXPECT_EQ(evaluate("floor(-1.1)"), "-2");
  EXPECT_EQ(evaluate("random() < 1 and random() >= 0"), "True");
}

TEST(MathTest, RejectsArgumentsOutsideTheDomain)
{
  EXPECT_EQ(evaluate("sqrt(-1)"), "error: sqrt: f must be in [0, inf], is -1");
  EXPECT_EQ(evaluate("asin(2)"), "error: asin: f must be in [-1, 1], is 2");
  EXPECT_EQ(evaluate("sin(\"a\")"), "error: sin: the argument 'f' must be a finite number, not string a");
}

TEST(ListTest, HaveLengthTransposeAndInverse)
{
  EXPECT_EQ(evaluate("get_list_length([1, 2, 3])"), "3");
  EXPECT_EQ(evaluate("size([[1, 2, 3], [4, 5, 6]])"), "[2, 3]");
  EXPECT_EQ(evaluate("transpose([[1, 2, 3], [4, 5, 6]])"), "[[1, 4], [2, 5], [3, 6]]");
  EXPECT_EQ(evaluate("inv([[2, 0], [0, 4]])"), "[[0.5, 0], [0, 0.25]]");
  EXPECT_EQ(evaluate("inv([[1, 1], [1, 1]])"), "error: inv: the matrix is singular");
  EXPECT_EQ(evaluate("make_list(3, 7, 10)"), "[7, 7, 7]");
  EXPECT_EQ(evaluate("make_list(1000000000, 7)"),
            "error: make_list: length must be in [0, 10000], is 1000000000");
}

TEST(ListTest, ConvertBetweenBitsAndIntegers)
{
  EXPECT_EQ(evaluate("binary_list_to_integer([True, False, True])"), "5");
  EXPECT_EQ(evaluate("binary_list_to_integer(make_list(40, True, 40))"), "-1");
  EXPECT_EQ(evaluate("binary_list_to_integer(integer_to_binary_list(-12345))"), "-12345");
  EXPECT_EQ(evaluate("get_list_length(integer_to_binary_list(1))"), "32");
}

TEST(StringTest, AreSearchedCutAndConverted)
{
  EXPECT_EQ(evaluate("str_cat(\"x = \", 1.5)"), "x = 1.5");
  EXPECT_EQ(evaluate("str_at(\"Hello\", 1)"), "e");
  EXPECT_EQ(evaluate("str_at(\"Hello\", 5)"), "error: str_at: index must be in [0, 4], is 5");
  EXPECT_EQ(evaluate("str_find(\"Hello World\", \"o\", 5)"), "7");
  EXPECT_EQ(evaluate("str_find(\"Hello\", \"z\")"), "-1");
  EXPECT_EQ(evaluate("str_find(\"Hello\", \"o\", 9)"), "-1");
  EXPECT_EQ(evaluate("str_find(\"Hello\", \"o\", -1)"), "error: str_find: start_from must not be negative");
  EXPECT_EQ(evaluate("str_sub(\"0123456789\", 5, 2)"), "56");
  EXPECT_EQ(evaluate("str_sub(\"0123456789\", 8)"), "89");
  EXPECT_EQ(evaluate("str_len(\"Hello\")"), "5");
  EXPECT_EQ(evaluate("str_empty(\"\")"), "True");
  EXPECT_EQ(evaluate("to_num(\"45\") + 1"), "46");
  EXPECT_EQ(evaluate("to_num(\"1.5\") + 1"), "2.5");
  EXPECT_EQ(evaluate("to_num(\"abc\")"), "error: to_num: 'abc' is not a number");
  EXPECT_EQ(evaluate("to_str([1, 2.5, True, \"a\"])"), "[1, 2.5, True, \"a\"]");
}

// The examples of the script manual, "to_str" and "to_num".
TEST(StringTest, NumbersHaveSixDecimalsWithoutTrailingZeros)
{
  EXPECT_EQ(evaluate("to_str(10)"), "10");
  EXPECT_EQ(evaluate("to_str(2.123456123456)"), "2.123456");
  EXPECT_EQ(evaluate("to_str(p[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])"), "p[1, 2, 3, 4, 5, 6]");
  EXPECT_EQ(evaluate("to_str([True, False, True])"), "[True, False, True]");
  EXPECT_EQ(evaluate("to_str(0.0000001)"), "0");
  EXPECT_EQ(evaluate("to_str(-0.0000001)"), "0");
  EXPECT_EQ(evaluate("to_str(100.0)"), "100");
  EXPECT_EQ(evaluate("to_str(1e20)"), "100000000000000000000");
  EXPECT_EQ(evaluate("to_str([[1.0 / 3, 2.0], [3.5, 4]])"), "[[0.333333, 2], [3.5, 4]]");
  EXPECT_EQ(evaluate("str_cat(\"third: \", 1.0 / 3)"), "third: 0.333333");
}

TEST(StringTest, TextsOfValuesHaveAtMost1023Characters)
{
  const std::string limit(1023, 'x');
  EXPECT_EQ(evaluate("str_len(str_cat(\"" + limit.substr(1) + "\", \"x\"))"), "1023");
  EXPECT_EQ(evaluate("str_cat(\"" + limit + "\", \"x\")"),
            "error: str_cat: the string has 1024 characters, more than 1023");
  EXPECT_EQ(evaluate("to_str(make_list(400, 7))"),
            "error: to_str: the string has 1200 characters, more than 1023");
}

TEST(StringTest, TextsBecomeIntegersFloatsOrErrors)
{
  EXPECT_EQ(evaluate("to_num(\"10\") / 4"), "2.5");
  EXPECT_EQ(evaluate("[7][to_num(\"0x3E\") - 62]"), "7");  // an int
  EXPECT_EQ(evaluate("to_num(\" 077\")"), "77");
  EXPECT_EQ(evaluate("to_num(\"-3.0e5\")"), "-300000");
  EXPECT_EQ(evaluate("to_num(\"+5.\")"), "5");
  EXPECT_EQ(evaluate("to_num(\"inf\")"), "inf");
  EXPECT_EQ(evaluate("to_num(\"-inf\")"), "-inf");
  EXPECT_EQ(evaluate("to_num(\"nan\")"), "nan");
  EXPECT_EQ(evaluate("to_num(\"2147483647\")"), "2147483647");
  EXPECT_EQ(evaluate("to_num(\"-2147483648\")"), "-2147483648");
  EXPECT_EQ(evaluate("to_num(\"99999999999\")"),
            "error: to_num: '99999999999' is out of the range of an int");
  EXPECT_EQ(evaluate("to_num(\"1e999\")"), "error: to_num: '1e999' is out of the range of a float");
  EXPECT_EQ(evaluate("to_num(\"123abc\")"), "error: to_num: '123abc' is not a number");
  EXPECT_EQ(evaluate("to_num(\"\")"), "error: to_num: '' is not a number");
}

TEST(StringTest, ASubstringHasNoNegativeLength)
{
  EXPECT_EQ(evaluate("str_sub(\"Hello\", 2, 0)"), "");
  EXPECT_EQ(evaluate("str_sub(\"Hello\", 2, -1)"), "error: str_sub: len must not be negative, is -1");
}

TEST(PoseBuiltinsTest, AreAddedSubtractedAndInverted)
{
  expect_near(six("pose_add(p[1,2,3,0,0,1], p[1,1,1,0,0,1])"), vector(2, 3, 4, 0, 0, 2));
  expect_near(six("pose_sub(p[.2,.5,.1,1.57,0,0], p[.2,.5,.6,1.57,0,0])"), vector(0, 0, -0.5, 0, 0, 0));
  expect_near(six("pose_add(pose_sub(p[1,2,3,.1,.2,.3], p[3,2,1,.3,.1,.2]), p[3,2,1,.3,.1,.2])"),
              vector(1, 2, 3, .1, .2, .3));
  expect_near(six("pose_trans(p[1,0,0,0,0,1.5707963267948966], p[1,0,0,0,0,0])"),
              vector(1, 1, 0, 0, 0, M_PI / 2));
  expect_near(six("pose_trans(p[1,2,3,.1,.2,.3], pose_inv(p[1,2,3,.1,.2,.3]))"), Vector6::Zero());
  expect_near(six("interpolate_pose(p[0,0,0,0,0,0], p[1,0,0,0,0,1], 0.25)"), vector(0.25, 0, 0, 0, 0, 0.25));
  EXPECT_NEAR(number("point_dist(p[0,0,0,1,1,1], p[3,4,0,0,0,0])"), 5.0, 1e-12);
}

TEST(PoseBuiltinsTest, ConvertRotationVectorsToRollPitchYawAndBack)
{
  EXPECT_EQ(evaluate("rpy2rotvec([0, 0, 0.5])"), "[0, 0, 0.5]");
  EXPECT_LT(number("norm(rotvec2rpy(rpy2rotvec([0.1, -0.2, 0.3])) - [0.1, -0.2, 0.3])"), 1e-9);
  EXPECT_LT(
      number("norm(rpy2rotvec(rotvec2rpy(rpy2rotvec([0.3, 1.5707963267948966, 0.1]))) - rpy2rotvec([0.3, "
             "1.5707963267948966, 0.1]))"),
      1e-6);
}

TEST(PoseBuiltinsTest, TransformAWrenchToAnotherFrame)
{
  // 10 N along Y; the new frame is displaced by 1 m along X and rotated by 90 degrees about Z.
  expect_near(six("wrench_trans(p[-1,0,0,0,0,0], [0,10,0,0,0,0])"), vector(0, 10, 0, 0, 0, 10));
  expect_near(six("wrench_trans(p[0,0,0,0,0,1.5707963267948966], [0,10,0,0,0,0])"),
              vector(10, 0, 0, 0, 0, 0));
}

TEST(ListBuiltinsTest, NormalizeGivesTheDirection)
{
  EXPECT_EQ(evaluate("normalize([3, 0, 4])"), "[0.6, 0, 0.8]");
  EXPECT_EQ(evaluate("normalize([0, 0])"),
            "error: normalize: the list has no direction: its norm must be positive and finite");
}

TEST(TextMessageTest, JoinBothArguments)
{
  ScriptRunner runner(
      "def test():\n textmsg(\"value: \", 3)\n textmsg(p[0.5,0,0,0,0,0])\n textmsg(\"\")\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.host.messages, (std::vector<std::string>{"value: 3", "p[0.5,0,0,0,0,0]", ""}));
}

// A recorded message: p[0.605825,-0.720087,0.233797,-0.0111368,-0.0111357,1.57073]
TEST(TextMessageTest, HasSixSignificantDigits)
{
  ScriptRunner runner(
      "def test():\n textmsg(p[0.60582512,-0.7200871,0.2337969,-0.01113678,-0.01113571,1.5707341])\n"
      " textmsg(\"x \", 1.0 / 3)\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::finished);
  EXPECT_EQ(runner.host.messages,
            (std::vector<std::string>{"p[0.605825,-0.720087,0.233797,-0.0111368,-0.0111357,1.57073]",
                                      "x 0.333333"}));
}

TEST(BuiltinCallTest, ErrorContainsTheRequiredArgumentWithoutValue)
{
  ScriptRunner runner("def test():\n def f():\n end\n x = sin(f())\nend");
  EXPECT_EQ(runner.finish(), MachineStatus::failed);
  EXPECT_EQ(runner.machine->error().message, "sin: the argument 'f' has no value");
}

}  // namespace
}  // namespace ur_simulator::urscript
