#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "plugins/plugin_index.hpp"
#include "plugins/plugin_selection.hpp"
#include "plugins/plugin_set.hpp"

namespace ur_ros_rtde {
namespace {
namespace fs = std::filesystem;

using Problems = std::vector<std::string>;

ReportProblem into(Problems & problems)
{
  return [&problems](const std::string & problem) { problems.push_back(problem); };
}

bool mentions(const std::string & text, const std::vector<std::string> & parts)
{
  return std::all_of(parts.begin(), parts.end(),
                     [&](const auto & part) { return text.find(part) != text.npos; });
}

PluginEntry entry(const std::string & name, const std::string & type)
{
  return {name, "test::" + type, command_base,
          "",   "test_package",  std::string(PREFIX) + "/lib/libplugin_" + name + ".so"};
}

/// A package in a prefix of its own.
class PluginFile : public testing::Test {
 protected:
  PluginFile() { fs::create_directories(folder_ / "lib"); }
  ~PluginFile() override { fs::remove_all(folder_); }

  std::vector<PluginEntry> read(const std::string & text)
  {
    const fs::path file = folder_ / "plugins.xml";
    std::ofstream(file) << text;
    return read_plugins_file(file.string(), "some_package", folder_.string(), into(problems_));
  }

  fs::path folder_ =
      fs::temp_directory_path() / ("plugin_file_test_" + std::to_string(::getpid()) + "_" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
  Problems problems_;
};

TEST_F(PluginFile, lists_the_plugins_of_all_its_libraries)
{
  const auto entries = read(R"(<class_libraries>
    <library path="one"><class name="a" type="x::A" base_class_type="ur_ros_rtde::CommandPlugin">
      <description>does a</description></class></library>
    <library path="two"><class name="b" type="x::B" base_class_type="ur_ros_rtde::DashboardPlugin"/></library>
    </class_libraries>)");
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].name, "a");
  EXPECT_EQ(entries[0].description, "does a");
  EXPECT_EQ(entries[0].library, (folder_ / "lib/libone.so").string());
  EXPECT_EQ(entries[1].base, dashboard_base);
  EXPECT_TRUE(problems_.empty());
}

TEST_F(PluginFile, that_is_torn_is_reported_with_its_name_and_line)
{
  EXPECT_TRUE(read("<library path='x'>\n<class name=").empty());
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugins.xml", "some_package", "line"})) << problems_[0];
}

TEST_F(PluginFile, of_something_else_is_reported)
{
  EXPECT_TRUE(read("<package/>").empty());
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"<package>", "<library>"})) << problems_[0];
}

TEST_F(PluginFile, leaves_out_and_reports_a_class_without_name_and_one_with_another_base)
{
  const auto entries =
      read(R"(<library path="one"><class type="x::A" base_class_type="ur_ros_rtde::CommandPlugin"/>
    <class name="b" type="x::B" base_class_type="nav2_core::Behavior"/>
    <class name="c" type="x::C" base_class_type="ur_ros_rtde::CommandPlugin"/></library>)");
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].name, "c");
  ASSERT_EQ(problems_.size(), 2U);
  EXPECT_TRUE(mentions(problems_[1], {"plugin b", "nav2_core::Behavior", command_base})) << problems_[1];
}

TEST_F(PluginFile, that_is_not_there_is_reported)
{
  read_plugins_file((folder_ / "none.xml").string(), "some_package", folder_.string(), into(problems_));
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"none.xml", "some_package"})) << problems_[0];
}

TEST(AmentIndex, gives_the_plugins_of_every_package_in_every_prefix)
{
  const fs::path prefix = fs::temp_directory_path() / ("ament_index_test_" + std::to_string(::getpid()));
  const fs::path index = prefix / "share/ament_index/resource_index/ur_ros_rtde__pluginlib__plugin";
  fs::create_directories(index);
  fs::create_directories(prefix / "share/one");
  std::ofstream(index / "one") << "share/one/plugins.xml\n";
  std::ofstream(index / "two") << "share/two/plugins.xml\n";  // names a file that is not there
  std::ofstream(prefix / "share/one/plugins.xml")
      << R"(<library path="l"><class name="a" type="A" base_class_type="ur_ros_rtde::CommandPlugin"/></library>)";
  ASSERT_EQ(::setenv("AMENT_PREFIX_PATH", prefix.c_str(), 1), 0);
  Problems problems;
  const auto entries = find_plugins(into(problems));
  fs::remove_all(prefix);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].package, "one");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(mentions(problems[0], {"share/two/plugins.xml", "two"})) << problems[0];
}

class Selection : public testing::Test {
 protected:
  std::vector<std::string> select(const std::vector<std::string> & chosen,
                                  const std::vector<std::string> & blacklist)
  {
    std::vector<std::string> names;
    for (const auto & selected : select_plugins(all_, command_base, chosen, blacklist, into(problems_))) {
      names.push_back(selected.name);
    }
    return names;
  }

  std::vector<PluginEntry> all_{entry("a", "A"), entry("b", "B"), entry("c", "C")};
  Problems problems_;
};

using Names = std::vector<std::string>;

TEST_F(Selection, takes_all_unless_told_otherwise)
{
  EXPECT_EQ(select({}, {}), (Names{"a", "b", "c"}));
  EXPECT_EQ(select({""}, {""}), (Names{"a", "b", "c"}));  // as YAML files write an empty list
  EXPECT_TRUE(problems_.empty());
}

TEST_F(Selection, takes_the_chosen_ones_without_the_blacklisted_ones)
{
  EXPECT_EQ(select({"c", "a"}, {}), (Names{"a", "c"}));
  EXPECT_EQ(select({}, {"b"}), (Names{"a", "c"}));
  EXPECT_EQ(select({"a", "b"}, {"b"}), (Names{"a"}));
}

TEST_F(Selection, names_unknown_plugins_and_the_nearest_one)
{
  all_.push_back(entry("move_joint", "MoveJoint"));
  EXPECT_EQ(select({"a", "mov_joints"}, {"cd"}), (Names{"a"}));
  ASSERT_EQ(problems_.size(), 2U);
  EXPECT_TRUE(mentions(problems_[0], {"plugins ", "\"mov_joints\"", "nearest is \"move_joint\""}))
      << problems_[0];
  EXPECT_TRUE(mentions(problems_[1], {"plugins_blacklist", "\"cd\"", "nearest is \"c\""})) << problems_[1];
}

TEST_F(Selection, says_nothing_of_names_that_plugins_of_the_other_server_have)
{
  all_[1].base = dashboard_base;
  EXPECT_EQ(select({"a", "b"}, {"b"}), (Names{"a"}));
  EXPECT_EQ(select({"b"}, {}), (Names{}));
  EXPECT_TRUE(problems_.empty()) << problems_[0];
}

TEST_F(Selection, of_nothing_at_all_names_what_is_unknown)
{
  all_.clear();
  EXPECT_EQ(select({"a"}, {}), (Names{}));
  ASSERT_EQ(problems_.size(), 1U);
}

TEST_F(Selection, keeps_the_first_of_two_with_the_same_name)
{
  all_.push_back(entry("a", "Other"));
  all_.back().package = "zz";
  EXPECT_EQ(select({}, {}), (Names{"a", "b", "c"}));
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugin a of package zz", "test_package"})) << problems_[0];
}

TEST_F(Selection, leaves_plugins_of_the_other_server_alone)
{
  all_[1].base = dashboard_base;
  EXPECT_EQ(select({}, {}), (Names{"a", "c"}));
}

/// Why a plugin of the test's libraries is refused; "" if it is not.
std::string refusal(const std::string & name, const std::string & type)
{
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(entry(name, type));
  return descriptor ? "" : descriptor.error().message;
}

TEST(PluginLibrary, that_is_right_gives_its_plugin)
{
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(entry("good", "Good"));
  ASSERT_TRUE(descriptor) << descriptor.error().message;
  EXPECT_STREQ((*descriptor)->name, "good");
  const std::unique_ptr<CommandPlugin> plugin((*descriptor)->create_command());
  EXPECT_NE(plugin, nullptr);
}

TEST(PluginLibrary, of_another_version_is_refused_with_both_versions)
{
  EXPECT_TRUE(mentions(refusal("wrong_abi", "WrongAbi"),
                       {"libplugin_wrong_abi.so", "version " + std::to_string(plugin_abi_version + 1),
                        "version " + std::to_string(plugin_abi_version)}));
}

TEST(PluginLibrary, without_the_export_is_refused_with_the_line_that_is_missing)
{
  EXPECT_TRUE(mentions(refusal("no_symbol", "NoSymbol"), {"UR_ROS_RTDE_EXPORT(NoSymbol, \"no_symbol\")"}));
}

TEST(PluginLibrary, with_another_name_than_its_description_is_refused_with_both)
{
  EXPECT_TRUE(mentions(refusal("wrong_name", "WrongName"), {"\"another_name\"", "\"wrong_name\""}));
}

TEST(PluginLibrary, with_another_base_than_its_description_is_refused)
{
  EXPECT_TRUE(mentions(refusal("wrong_base", "WrongBase"), {"test::WrongBase", command_base}));
}

TEST(PluginLibrary, that_does_not_exist_or_is_no_library_is_refused)
{
  EXPECT_TRUE(mentions(refusal("nowhere", "Nowhere"), {"libplugin_nowhere.so"}));
  PluginEntry text = entry("good", "Good");
  text.library = __FILE__;
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(text);
  ASSERT_FALSE(descriptor);
  EXPECT_TRUE(mentions(descriptor.error().message, {"cannot be loaded"})) << descriptor.error().message;
}

TEST(PluginLibrary, that_lacks_a_symbol_is_refused_with_the_symbol)
{
  EXPECT_TRUE(mentions(refusal("undefined_symbol", "UndefinedSymbol"), {"data_defined_nowhere"}))
      << refusal("undefined_symbol", "UndefinedSymbol");
}

TEST(PluginLibrary, whose_plugin_throws_later_is_left_out_too)
{
  PluginSet<CommandPlugin, CommandHost> set;
  Problems problems;
  set.load({entry("good", "Good")}, into(problems));
  set.with_each("it threw when it was asked", into(problems),
                [](const PluginEntry &, CommandPlugin &) { throw std::runtime_error("no answer"); });
  EXPECT_EQ(set.names(), Names{});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(mentions(problems[0], {"plugin good", "it threw when it was asked: no answer"})) << problems[0];
}

TEST(PluginLibrary, whose_constructor_throws_is_left_out_with_the_text_and_the_rest_goes_on)
{
  PluginSet<CommandPlugin, CommandHost> set;
  Problems problems;
  set.load({entry("throws", "Throws"), entry("good", "Good")}, into(problems));
  EXPECT_EQ(set.names(), (Names{"good"}));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(mentions(problems[0], {"plugin throws of package test_package", "the gripper is not there"}))
      << problems[0];
}

}  // namespace
}  // namespace ur_ros_rtde
