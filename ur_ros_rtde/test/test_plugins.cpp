#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <rcl_cxx/error.hpp>

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
class PluginDescriptionTest : public testing::Test {
 protected:
  PluginDescriptionTest() { fs::create_directories(folder_ / "lib"); }
  ~PluginDescriptionTest() override { fs::remove_all(folder_); }

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

TEST_F(PluginDescriptionTest, ListsThePluginsOfAllLibraries)
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

TEST_F(PluginDescriptionTest, ReportsIncompleteXmlWithNameAndLine)
{
  EXPECT_TRUE(read("<library path='x'>\n<class name=").empty());
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugins.xml", "some_package", "Line number=2"})) << problems_[0];
}

TEST_F(PluginDescriptionTest, ReportsAnotherRootElement)
{
  EXPECT_TRUE(read("<package/>").empty());
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"<package>", "<library>"})) << problems_[0];
}

TEST_F(PluginDescriptionTest, ReportsADescriptionWithoutElement)
{
  EXPECT_TRUE(read("<?xml version=\"1.0\"?><!DOCTYPE library>").empty());
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugins.xml", "some_package", "no element", "<library>"}))
      << problems_[0];
}

TEST_F(PluginDescriptionTest, SkipsAndReportsInvalidClasses)
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

TEST_F(PluginDescriptionTest, ReportsAMissingFile)
{
  read_plugins_file((folder_ / "none.xml").string(), "some_package", folder_.string(), into(problems_));
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"none.xml", "some_package"})) << problems_[0];
}

TEST(AmentIndexTest, FindsThePluginsOfAllPackagesInAllPrefixes)
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

class PluginSelectionTest : public testing::Test {
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

TEST_F(PluginSelectionTest, SelectsAllByDefault)
{
  EXPECT_EQ(select({}, {}), (Names{"a", "b", "c"}));
  EXPECT_EQ(select({""}, {""}), (Names{"a", "b", "c"}));  // as YAML files write an empty list
  EXPECT_TRUE(problems_.empty());
}

TEST_F(PluginSelectionTest, SelectsChosenPluginsWithoutTheBlacklist)
{
  EXPECT_EQ(select({"c", "a"}, {}), (Names{"a", "c"}));
  EXPECT_EQ(select({}, {"b"}), (Names{"a", "c"}));
  EXPECT_EQ(select({"a", "b"}, {"b"}), (Names{"a"}));
}

TEST_F(PluginSelectionTest, RejectsUnknownNamesWithASimilarOne)
{
  all_.push_back(entry("move_joint", "MoveJoint"));
  try {
    select({"a", "mov_joints", "nosuch"}, {});
    ADD_FAILURE();
  } catch (const rcl_cxx::ParameterError & error) {
    EXPECT_EQ(error.parameter(), "plugins");
    EXPECT_TRUE(mentions(error.what(), {"\"mov_joints\"", "did you mean \"move_joint\"?", "\"nosuch\""}))
        << error.what();
  }
}

TEST_F(PluginSelectionTest, ReportsUnknownNamesInTheBlacklist)
{
  EXPECT_EQ(select({"a"}, {"cd"}), (Names{"a"}));
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugins_blacklist", "\"cd\"", "did you mean \"c\"?"})) << problems_[0];
}

TEST_F(PluginSelectionTest, AcceptsNamesOfTheOtherServer)
{
  all_[1].base = dashboard_base;
  EXPECT_EQ(select({"a", "b"}, {"b"}), (Names{"a"}));
  EXPECT_EQ(select({"b"}, {}), (Names{}));
  EXPECT_TRUE(problems_.empty()) << problems_[0];
}

TEST_F(PluginSelectionTest, RejectsUnknownNamesWithoutAnyPlugin)
{
  all_.clear();
  EXPECT_THROW(select({"a"}, {}), rcl_cxx::ParameterError);
}

TEST_F(PluginSelectionTest, KeepsTheFirstOfTwoWithTheSameName)
{
  all_.push_back(entry("a", "Other"));
  all_.back().package = "zz";
  EXPECT_EQ(select({}, {}), (Names{"a", "b", "c"}));
  ASSERT_EQ(problems_.size(), 1U);
  EXPECT_TRUE(mentions(problems_[0], {"plugin a of package zz", "test_package"})) << problems_[0];
}

TEST_F(PluginSelectionTest, IgnoresPluginsOfTheOtherServer)
{
  all_[1].base = dashboard_base;
  EXPECT_EQ(select({}, {}), (Names{"a", "c"}));
}

/// Why a plugin of the test's libraries is rejected; "" if it is not.
std::string rejection(const std::string & name, const std::string & type)
{
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(entry(name, type));
  return descriptor ? "" : descriptor.error().message;
}

TEST(PluginLibraryTest, CreatesItsPlugin)
{
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(entry("good", "Good"));
  ASSERT_TRUE(descriptor) << descriptor.error().message;
  EXPECT_STREQ((*descriptor)->name, "good");
  const std::unique_ptr<CommandPlugin> plugin((*descriptor)->create_command());
  EXPECT_NE(plugin, nullptr);
}

TEST(PluginLibraryTest, RejectsALibraryThatWasBuiltWithOtherHeaders)
{
  EXPECT_TRUE(mentions(rejection("wrong_abi", "WrongAbi"),
                       {"libplugin_wrong_abi.so", "the headers of another version", "another"}));
}

TEST(PluginLibraryTest, RejectsALibraryThatDoesNotTellItsHeaders)
{
  EXPECT_TRUE(
      mentions(rejection("no_abi", "NoAbi"), {"libplugin_no_abi.so", "ur_ros_rtde_register_plugins()"}));
}

TEST(PluginLibraryTest, RejectsAMissingExportAndNamesIt)
{
  EXPECT_TRUE(mentions(rejection("no_symbol", "NoSymbol"), {"UR_ROS_RTDE_EXPORT(NoSymbol, \"no_symbol\")"}));
}

TEST(PluginLibraryTest, RejectsAnotherNameThanInTheDescription)
{
  EXPECT_TRUE(mentions(rejection("wrong_name", "WrongName"), {"\"another_name\"", "\"wrong_name\""}));
}

TEST(PluginLibraryTest, RejectsAnotherBaseClassThanInTheDescription)
{
  EXPECT_TRUE(mentions(rejection("wrong_base", "WrongBase"), {"test::WrongBase", command_base}));
}

TEST(PluginLibraryTest, RejectsAMissingOrInvalidFile)
{
  EXPECT_TRUE(mentions(rejection("nowhere", "Nowhere"), {"libplugin_nowhere.so"}));
  PluginEntry text = entry("good", "Good");
  text.library = __FILE__;
  PluginLibraries libraries;
  const auto descriptor = libraries.describe(text);
  ASSERT_FALSE(descriptor);
  EXPECT_TRUE(mentions(descriptor.error().message, {"cannot be loaded"})) << descriptor.error().message;
}

TEST(PluginLibraryTest, RejectsAnUndefinedSymbolAndNamesIt)
{
  EXPECT_TRUE(mentions(rejection("undefined_symbol", "UndefinedSymbol"), {"data_defined_nowhere"}))
      << rejection("undefined_symbol", "UndefinedSymbol");
}

TEST(PluginLibraryTest, RemovesAPluginThatThrowsLater)
{
  PluginSet<CommandPlugin, CommandHost> set;
  Problems problems;
  set.load({entry("good", "Good")}, into(problems));
  set.with_each("the query threw", into(problems),
                [](const PluginEntry &, CommandPlugin &) { throw std::runtime_error("no answer"); });
  EXPECT_EQ(set.names(), Names{});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(mentions(problems[0], {"plugin good", "the query threw: no answer"})) << problems[0];
}

TEST(PluginLibraryTest, SkipsAPluginWhoseConstructorThrows)
{
  PluginSet<CommandPlugin, CommandHost> set;
  Problems problems;
  set.load({entry("throws", "Throws"), entry("good", "Good")}, into(problems));
  EXPECT_EQ(set.names(), (Names{"good"}));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(mentions(problems[0], {"plugin throws of package test_package", "the gripper is not there"}))
      << problems[0];
}

TEST(PluginLibraryTest, DestroysAPluginThatThrowsWhenItIsStopped)
{
  PluginSet<CommandPlugin, CommandHost> set;
  Problems problems;
  set.load({entry("throws_at_stop", "ThrowsAtStop"), entry("good", "Good")}, into(problems));
  ASSERT_EQ(set.names(), (Names{"throws_at_stop", "good"}));
  EXPECT_NO_THROW(set.stop());
  EXPECT_EQ(set.names(), Names{});
}

}  // namespace
}  // namespace ur_ros_rtde
