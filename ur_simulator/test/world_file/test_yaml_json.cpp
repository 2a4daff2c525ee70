#include <gtest/gtest.h>

#include "world_file/yaml_json.hpp"

namespace ur_simulator {
namespace {

using nlohmann::json;

json converted(const std::string & text)
{
  return to_json(YAML::Load(text));
}

/// "line: text" of the error.
std::string conversion_error(const std::string & text)
{
  try {
    return "no error: " + converted(text).dump();
  } catch (const YamlError & error) {
    return std::to_string(error.line()) + ": " + error.what();
  }
}

TEST(YamlJsonTest, PlainScalarsHaveTheTypesOfTheCoreSchema)
{
  EXPECT_EQ(
      converted("[1, +2, -3, 1.5, 1e3, .5, true, False, null, ~, text, 1.2.3, inf, nan]"),
      json::parse(R"([1, 2, -3, 1.5, 1000.0, 0.5, true, false, null, null, "text", "1.2.3", "inf", "nan"])"));
  EXPECT_TRUE(converted("1").is_number_integer());
  EXPECT_TRUE(converted("1.0").is_number_float());
}

TEST(YamlJsonTest, QuotedScalarsAndBlocksAreStrings)
{
  EXPECT_EQ(converted("['1', \"true\", 'null']"), json::parse(R"(["1", "true", "null"])"));
  EXPECT_EQ(converted("script: |\n  def f():\n  end\n")["script"], "def f():\nend\n");
}

TEST(YamlJsonTest, ConvertsMapsAndAliases)
{
  EXPECT_EQ(converted("a: &x {b: 1}\nc: *x\n"), json::parse(R"({"a": {"b": 1}, "c": {"b": 1}})"));
}

TEST(YamlJsonTest, RejectsKeysThatAreNoNamesOrOccurTwice)
{
  EXPECT_EQ(conversion_error("a: 1\n[b]: 2\n"), "2: a name of a field is missing: give name: value");
  EXPECT_EQ(conversion_error("a: 1\nb: 2\na: 3\n"), "3: field 'a' is given twice: remove one of them");
}

TEST(YamlJsonTest, LimitsNestingAndSize)
{
  EXPECT_NE(conversion_error(std::string(30, '[') + std::string(30, ']')).find("nested more than 16"),
            std::string::npos);
  std::string aliases = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    aliases += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) {
      aliases += "*a" + std::to_string(i - 1) + (j < 9 ? ", " : "]\n");
    }
  }
  EXPECT_NE(conversion_error(aliases).find("more than 100000 values"), std::string::npos);
}

TEST(YamlJsonTest, FindsTheLineOfAField)
{
  const YAML::Node node = YAML::Load("a: 1\nb:\n  c: 2\n");
  EXPECT_EQ(line_of(node, "b"), 2);
  EXPECT_EQ(line_of(node["b"], "c"), 3);
  EXPECT_EQ(line_of(node, "other"), 1);
}

}  // namespace
}  // namespace ur_simulator
