#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "script/control_script.hpp"
#include "script/registers.hpp"
#include "script/scan.hpp"

namespace ur_ros_rtde::script {
namespace {

std::string base()
{
  std::ifstream file(CONTROL_SCRIPT);
  return {std::istreambuf_iterator<char>(file), {}};
}

ScriptExtension extension(const std::string & name, const std::string & snippet)
{
  ScriptExtension result;
  result.name = name;
  result.snippet = snippet;
  return result;
}

std::string complaint(const std::string & script, const std::vector<ScriptExtension> & extensions)
{
  const auto composed = compose(script, extensions);
  return composed ? "none" : composed.error().message;
}

int line_of(const std::string & text, const std::string & part)
{
  const auto found = text.find(part);
  EXPECT_NE(found, std::string::npos) << part;
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(found), '\n'));
}

TEST(ControlScriptTest, IsUnchangedWithoutExtensions)
{
  const auto composed = compose(base(), {});
  ASSERT_TRUE(composed);
  EXPECT_EQ(composed->text.text(), base());
  EXPECT_TRUE(composed->ids.empty());
}

TEST(ControlScriptTest, NumbersExtensionsInOrderOfTheirNames)
{
  const auto composed = compose(
      base(), {extension("sg_release", "sync()"), extension("sg_grip", "sync()"), extension("a1", "")});
  ASSERT_TRUE(composed) << composed.error().message;
  EXPECT_EQ(composed->ids, (std::map<std::string, int>{{"a1", 256}, {"sg_grip", 257}, {"sg_release", 258}}));
}

TEST(ControlScriptTest, KeepsEveryOriginalLine)
{
  const auto composed = compose(base(), {extension("a", "sync()")});
  ASSERT_TRUE(composed);
  std::string own;
  const std::string & text = composed->text.text();
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const auto end = text.find('\n', begin) + 1;
    const Origin origin = composed->text.origin(line);
    if (origin.source == 0 && origin.line > 0) {
      own += text.substr(begin, end - begin);
    }
    begin = end;
  }
  EXPECT_EQ(own, base());
}

TEST(ControlScriptTest, SupportsEachVersionAndRegisterRange)
{
  const auto composed = compose(base(), {extension("a", "$5.10 x = 1\n$5.90 y = 1\nz = $in20i\n")});
  ASSERT_TRUE(composed) << composed.error().message;
  for (const auto & [major, minor] : {std::pair{3U, 5U}, {3U, 15U}, {5U, 0U}, {5U, 10U}, {5U, 25U}}) {
    const auto script = for_controller(*composed, major, minor, major == 5);
    ASSERT_TRUE(script) << script.error().message;
    const std::string & text = script->text.text();
    EXPECT_EQ(text.find('$'), std::string::npos);
    EXPECT_EQ(text.find("register offset"), std::string::npos);
    EXPECT_NE(text.find(major == 5 ? "reg_offset_int = 24\n" : "reg_offset_int = 0\n"), std::string::npos);
    EXPECT_EQ(text.find("x = 1\n") != std::string::npos, major == 5 && minor >= 10);
    EXPECT_EQ(text.find("y = 1\n"), std::string::npos);
    EXPECT_EQ(text.find("get_inverse_kin_has_solution(x)") != std::string::npos, minor >= 10);
    EXPECT_EQ(place(*script, line_of(text, "z = read_input_integer_reg(20)")), "extension `a`, line 3");
    EXPECT_EQ(place(*script, line_of(text, "def process_cmd")), "");
  }
}

/// How often the extensions end a mode: once after they have finished, once when they are stopped.
std::ptrdiff_t count_ends(const std::vector<ScriptExtension> & extensions, const std::string & end,
                          unsigned major = 5, unsigned minor = 25)
{
  const auto lines = [&](const std::vector<ScriptExtension> & added) {
    const auto composed = compose(base(), added);
    const std::string text = for_controller(*composed, major, minor, false)->text.text();
    std::ptrdiff_t count = 0;
    for (auto at = text.find(" " + end); at != std::string::npos; at = text.find(" " + end, at + 1)) {
      ++count;
    }
    return count;
  };
  return lines(extensions) - lines({});
}

TEST(ControlScriptTest, EndsOnlyTheModesThatTheCodeOfAnExtensionStarts)
{
  const auto none = extension("a", "end_freedrive_mode()\n# freedrive_mode()\ntextmsg(\"force_mode(\")\n");
  for (const char * end : {"end_force_mode()", "end_freedrive_mode()", "end_teach_mode()"}) {
    EXPECT_EQ(count_ends({none}, end), 0) << end;
  }
  const auto guide = extension("guide", "freedrive_mode()\n");
  EXPECT_EQ(count_ends({none, guide}, "end_freedrive_mode()"), 2);
  EXPECT_EQ(count_ends({none, guide}, "end_teach_mode()"), 0);
  EXPECT_EQ(count_ends({none, guide}, "if (extension_id == 257):"), 2) << "not after the other one";
  auto press = extension("press", "press()\n");
  press.preamble = "def press():\n  force_mode(get_target_tcp_pose(), axes, wrench, 2, limits)\nend\n";
  EXPECT_EQ(count_ends({press}, "if is_in_forcemode == 0 and (extension_id == 256):"), 2);
  EXPECT_EQ(count_ends({press}, "end_force_mode()"), 2);
}

TEST(ControlScriptTest, EndsFreedriveOnEachController)
{
  const auto guide = extension("guide", "freedrive_mode()\n");
  const std::vector<std::pair<unsigned, unsigned>> versions{{3, 5}, {3, 15}, {5, 0}, {5, 9}, {5, 10}};
  for (const auto & [major, minor] : versions) {
    EXPECT_EQ(count_ends({guide}, "end_freedrive_mode()", major, minor), 2) << major << "." << minor;
  }
}

TEST(ControlScriptTest, ContainsSharedPreamblesOnce)
{
  auto a = extension("a", "grip()");
  a.preamble_name = "gripper";
  a.preamble = "def grip():\n  $out19i($in19i)\nend\n";
  auto b = a;
  b.name = "b";
  const auto composed = compose(base(), {a, b});
  ASSERT_TRUE(composed) << composed.error().message;
  const std::string & text = composed->text.text();
  const auto first = text.find("def grip()");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("def grip()", first + 1), std::string::npos);
  EXPECT_NE(text.find("write_output_integer_reg(19, read_input_integer_reg(19))"), std::string::npos);
  EXPECT_EQ(place(*composed, line_of(text, "write_output_integer_reg(19, read")),
            "extension `a`, preamble, line 2");
  b.preamble += "\n";
  EXPECT_EQ(complaint(base(), {a, b}),
            "the extensions `a` and `b` define the preamble `gripper` differently");
}

TEST(ExtensionCompositionTest, RejectsInvalidExtensionsByName)
{
  const auto of = [](const std::string & snippet) { return complaint(base(), {extension("x", snippet)}); };
  EXPECT_EQ(of("sync()\nif True:\n  sync()\n"), "extension `x`, line 2: the `if` has no `end`");
  EXPECT_EQ(of("end\n"), "extension `x`, line 1: this `end` has no block");
  EXPECT_EQ(of("sync()\nhalt"), "extension `x`, line 2: `halt` would end the control program");
  EXPECT_EQ(
      of("\ny = $in19"),
      "extension `x`, line 2: `$in19` is not a register: write $in19i, $in19f, $out19i(x) or $out19f(x)");
  EXPECT_EQ(of("y = $in18f"),
            "extension `x`, line 1: input float register 18 is not available to extensions: use 19 to 22");
  EXPECT_EQ(of("$out18f(1)"),
            "extension `x`, line 1: output float register 18 is not available to extensions: use 13 to 19 "
            "except 18");
  EXPECT_EQ(of("$out3i(1)"),
            "extension `x`, line 1: output integer register 3 is not available to extensions: use 12 to 19");
  EXPECT_EQ(complaint(base(), {extension("X y", "")}).find("`X y` is not a valid name"), 0U);
  EXPECT_EQ(complaint(base(), {extension("x", ""), extension("x", "")}),
            "there are two extensions `x`: leave one out");
  auto declared = extension("x", "");
  declared.registers.input_double = {40};
  EXPECT_EQ(complaint(base(), {declared})
                .find("extension `x`: input float register 40 is not available to extensions"),
            0U);
}

TEST(ExtensionCompositionTest, SharesRegistersUnlessOneIsExclusive)
{
  auto a = extension("a", "$out19i($in19i)");
  auto b = extension("b", "$out19i(1)");
  EXPECT_EQ(complaint(base(), {a, b}), "none");
  b.exclusive = true;
  EXPECT_EQ(complaint(base(), {a, b}), "the extensions `a` and `b` both use output integer register 19");
  EXPECT_EQ(complaint(base(), {extension("a", "$out18i(1)"), b}), "none");
}

TEST(ExtensionCompositionTest, RejectsExtensionsWithoutAnAnchor)
{
  std::string other = base();
  const std::string anchor = "            cmd = rtde_cmd()\n";
  other.replace(other.find(anchor), anchor.size(), "\n");
  EXPECT_EQ(complaint(other, {extension("x", "")}),
            "extension `x` cannot be added: the control script has the line `cmd = rtde_cmd()` nowhere");
  EXPECT_EQ(
      complaint(base() + anchor, {extension("x", "")}),
      "extension `x` cannot be added: the control script has the line `cmd = rtde_cmd()` more than once");
}

}  // namespace
}  // namespace ur_ros_rtde::script
