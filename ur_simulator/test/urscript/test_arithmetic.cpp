#include "support/script_runner.hpp"

namespace ur_simulator::urscript {
namespace {

TEST(ArithmeticTest, KeepsIntegersAndDividesToFloats)
{
  EXPECT_EQ(evaluate("1+2-3"), "0");
  EXPECT_EQ(evaluate("4*5/6 == 3.3333333333333335"), "True");
  EXPECT_EQ(evaluate("(1+2)*3/(4-5)"), "-9");
  EXPECT_EQ(evaluate("5 / 2"), "2.5");
  EXPECT_EQ(evaluate("17 % 5"), "2");
  EXPECT_EQ(evaluate("5.5 % 2"), "1.5");
  EXPECT_EQ(evaluate("2 + 0.5"), "2.5");
}

TEST(ArithmeticTest, BindsTighterThanComparisonsAndTheseTighterThanLogic)
{
  EXPECT_EQ(evaluate("True or False and (1 == 2)"), "True");
  EXPECT_EQ(evaluate("1 > 2 or 3 != 4 xor 5 < -6"), "True");
  EXPECT_EQ(evaluate("not 42 >= 87 and 87 <= 42"), "False");
  EXPECT_EQ(evaluate("not 1 == 2"), "True");
  EXPECT_EQ(evaluate("-2 * -3 + 1"), "7");
  EXPECT_EQ(evaluate("2 - 3 - 4"), "-5");
}

TEST(ArithmeticTest, WrapsIntegersAt32Bit)
{
  EXPECT_EQ(evaluate("2147483647 + 1"), "-2147483648");
  EXPECT_EQ(evaluate("127 * 16777216 + 127 * 65536 + 65535"), "2139095039");
}

TEST(ArithmeticTest, ReadsLeadingZerosAsDecimalAndExponents)
{
  EXPECT_EQ(evaluate("024"), "24");
  EXPECT_EQ(evaluate("00"), "0");
  EXPECT_EQ(evaluate("1e-07 == 0.0000001"), "True");
  EXPECT_EQ(evaluate(".5 + 1."), "1.5");
  EXPECT_EQ(evaluate("4294967296"), "4294967296");
}

TEST(ArithmeticTest, ComparesIntFloatAndBoolByValue)
{
  EXPECT_EQ(evaluate("1 == 1.0"), "True");
  EXPECT_EQ(evaluate("True == 1"), "True");
  EXPECT_EQ(evaluate("0.5 <= 1"), "True");
  EXPECT_EQ(evaluate("\"abc\" == \"abc\""), "True");
  EXPECT_EQ(evaluate("\"a\" == 1"), "False");
  EXPECT_EQ(evaluate("p[1,2,3,0,0,0] == p[1,2,3,0,0,0]"), "True");
  EXPECT_EQ(evaluate("[1, 2] != [1, 3]"), "True");
}

TEST(ArithmeticTest, JoinsStrings)
{
  EXPECT_EQ(evaluate("\"Hello\" + \", \" + \"World!\""), "Hello, World!");
  EXPECT_EQ(evaluate("'single' + \" and # double\""), "single and # double");
}

TEST(ArithmeticTest, WorksOnArraysElementByElement)
{
  EXPECT_EQ(evaluate("[1,2,3] * [10,20,30]"), "[10, 40, 90]");
  EXPECT_EQ(evaluate("[10,20,30] / [1,2,3]"), "[10, 10, 10]");
  EXPECT_EQ(evaluate("[1,2,3] + 10"), "[11, 12, 13]");
  EXPECT_EQ(evaluate("10 - [1,2,3]"), "[9, 8, 7]");
  EXPECT_EQ(evaluate("-[1,2]"), "[-1, -2]");
}

TEST(ArithmeticTest, MultipliesMatricesWithMatricesArraysAndNumbers)
{
  EXPECT_EQ(evaluate("[[1,2],[3,4],[5,6]] * [[10,20,30],[40,50,60]]"),
            "[[90, 120, 150], [190, 260, 330], [290, 400, 510]]");
  EXPECT_EQ(evaluate("[[1,2],[3,4],[5,6]] * [10,20]"), "[50, 110, 170]");
  EXPECT_EQ(evaluate("5 * [[1,2],[3,4]]"), "[[5, 10], [15, 20]]");
  EXPECT_EQ(evaluate("[[1,2],[3,4]] - [[1,1],[1,1]]"), "[[0, 1], [2, 3]]");
  EXPECT_EQ(evaluate("[[1,2],[3,4]] * [[1,2,3]]"), "error: a 2x2 matrix cannot be multiplied by a 1x3 one");
}

TEST(ArithmeticTest, RejectsUnsuitableTypesAndDivisionByZero)
{
  EXPECT_EQ(evaluate("1 + \"a\""), "error: Type error: '+' does not take int and string");
  EXPECT_EQ(evaluate("[1, 2] + [1]"), "error: '+' of lists of different lengths: 2 and 1");
  EXPECT_EQ(evaluate("1 / 0"), "error: division by zero");
  EXPECT_EQ(evaluate("1 % 0"), "error: division by zero");
  EXPECT_EQ(evaluate("-\"a\""), "error: Type error: '-' does not take string");
  EXPECT_EQ(evaluate("\"a\" < 2"), "error: Type error: '<' does not take string and int");
  EXPECT_EQ(evaluate("not [1]"), "error: Type error: a condition must be a bool, not list");
}

TEST(ArithmeticTest, EvaluatesTheRightSideOfAndOrOnlyWhenNeeded)
{
  EXPECT_EQ(evaluate("True or 1 / 0 == 1"), "True");
  EXPECT_EQ(evaluate("False and 1 / 0 == 1"), "False");
  EXPECT_EQ(evaluate("False or False or 3 == 3"), "True");
  EXPECT_EQ(evaluate("True and True and False"), "False");
}

}  // namespace
}  // namespace ur_simulator::urscript
