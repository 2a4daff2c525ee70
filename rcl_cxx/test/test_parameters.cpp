#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "rcl_cxx/rcl_cxx.hpp"
#include "ros_fixture.hpp"

using rcl_cxx::Node;
using rcl_cxx::Parameter;
using rcl_cxx::ParameterError;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {
std::string error_of(const std::function<void()> & action)
{
  try {
    action();
  } catch (const ParameterError & error) {
    return error.what();
  }
  return "no exception";
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string & text)
  {
    std::string name = (std::filesystem::temp_directory_path() / "rcl_cxx_XXXXXX.yaml").string();
    const int fd = ::mkstemps(name.data(), 5);
    EXPECT_GE(fd, 0);
    ::close(fd);
    path_ = name;
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile &) = delete;
  TemporaryFile & operator=(const TemporaryFile &) = delete;
  const std::string & path() const { return path_; }

 private:
  std::string path_;
};
}  // namespace

TEST(ParameterOverrideTest, OfCommandLineReplacesDefault)
{
  const auto context =
      make_context({"--ros-args", "-p", "speed:=0.25", "-p", "host:=robot", "-p", "other:speed:=9.0"});
  Node node(context, "node");
  EXPECT_EQ(node.declare_parameter("speed", 1.0), 0.25);
  EXPECT_EQ(node.declare_parameter("host", "localhost"), "robot");
  EXPECT_EQ(node.declare_parameter("untouched", 3), 3);
}

TEST(ParameterOverrideTest, OfAnUndeclaredParameterIsListed)
{
  Node node(make_context({"--ros-args", "-p", "sped:=0.25", "-p", "host:=robot", "-p", "other:speed:=9.0"}),
            "node");
  node.declare_parameter("host", "localhost");
  node.declare_parameter("speed", 1.0);
  EXPECT_THAT(node.undeclared_overrides(), ElementsAre("sped"));
  EXPECT_THAT(node.list_parameters(), testing::IsSupersetOf({"host", "speed"}));
}

TEST(ParameterOverrideTest, OfIntegerIsConvertedToDouble)
{
  const auto context = make_context({"--ros-args", "-p", "speed:=1", "-p", "home:=[1, 2]"});
  Node node(context, "node");
  EXPECT_EQ(node.declare_parameter("speed", 0.5), 1.0);
  EXPECT_THAT(node.declare_parameter<std::vector<double>>("home", {}), ElementsAre(1.0, 2.0));
}

TEST(ParameterOverrideTest, MayBeAnEmptyList)
{
  Node node(make_context({"--ros-args", "-p", "plugins:=[]", "-p", "home:=[]", "-p", "speed:=[]"}), "node");
  EXPECT_THAT(node.declare_parameter<std::vector<std::string>>("plugins", {"move_j"}), testing::IsEmpty());
  EXPECT_THAT(node.declare_parameter<std::vector<double>>("home", {1.0}), testing::IsEmpty());
  EXPECT_THROW(node.declare_parameter("speed", 1.0), rcl_cxx::Error);
}

TEST(ParameterOverrideTest, IsRejectedWithWrongTypeOrOutOfRange)
{
  const auto context = make_context({"--ros-args", "-p", "host:=1", "-p", "speed:=9.0"});
  Node node(context, "node");
  EXPECT_THAT(error_of([&] { node.declare_parameter("host", "x"); }),
              HasSubstr("of type string, it cannot be 1"));
  EXPECT_THAT(error_of([&] {
                node.declare_parameter("speed", 1.0,
                                       {.floating_point_range = rcl_cxx::FloatingPointRange{0.0, 3.0}});
              }),
              HasSubstr("range 0 to 3, it cannot be 9.0"));
}

TEST(ParameterOverrideTest, IsReadFromFilesByNodeName)
{
  const TemporaryFile file(R"(
/**:
  ros__parameters:
    everywhere: 1
    host: all
/robot/node:
  ros__parameters:
    host: mine
    nested: {deeper: {value: 2.5}}
    list: [a, b]
/other/node:
  ros__parameters:
    host: foreign
)");
  const auto context = make_context({"--ros-args", "--params-file", file.path(), "-p", "everywhere:=5"});
  Node node(context, "node", "/robot");
  EXPECT_EQ(node.declare_parameter("host", "none"), "mine");
  EXPECT_EQ(node.declare_parameter("nested.deeper.value", 0.0), 2.5);
  EXPECT_EQ(node.declare_parameter("everywhere", 0), 5);
  EXPECT_THAT(node.declare_parameter<std::vector<std::string>>("list", {}), ElementsAre("a", "b"));
}

class ParameterTest : public testing::Test {
 protected:
  std::shared_ptr<rcl_cxx::Context> context = make_context();
  Node node{context, "node"};
};

TEST_F(ParameterTest, IsDeclaredOnce)
{
  node.declare_parameter("a", 1);
  EXPECT_THAT(error_of([&] { node.declare_parameter("a", 1); }), HasSubstr("'a' is declared already"));
  EXPECT_THAT(error_of([&] { node.declare_parameter("", 1); }), HasSubstr("needs a name"));
  EXPECT_THAT(error_of([&] { node.declare_parameter("b", rcl_cxx::ParameterValue()); }),
              HasSubstr("'b' needs a name and a default value"));
}

TEST_F(ParameterTest, IsUnknownUntilDeclared)
{
  EXPECT_FALSE(node.has_parameter("a"));
  EXPECT_THAT(error_of([&] { node.get_parameter("a"); }), HasSubstr("'a' is not declared"));
  EXPECT_THAT(node.set_parameter("a", 1).error(), HasSubstr("'a' cannot be set because it was not declared"));
  node.declare_parameter("a", 1);
  EXPECT_TRUE(node.has_parameter("a"));
  EXPECT_EQ(node.get_parameter<int>("a"), 1);
}

TEST_F(ParameterTest, StaysWithinItsRange)
{
  const rcl_cxx::ParameterDescriptor options{.integer_range = rcl_cxx::IntegerRange{0, 10}};
  EXPECT_THAT(error_of([&] { node.declare_parameter("n", 11, options); }), HasSubstr("range 0 to 10"));
  node.declare_parameter("n", 5, options);
  EXPECT_FALSE(node.set_parameter("n", -1));
  EXPECT_TRUE(node.set_parameter("n", 10));
  EXPECT_EQ(node.get_parameter<int>("n"), 10);
}

TEST_F(ParameterTest, CannotBeSetWhenReadOnly)
{
  node.declare_parameter("model", "ur5e", {.read_only = true});
  EXPECT_THAT(node.set_parameter("model", "ur10e").error(), HasSubstr("read-only"));
}

TEST_F(ParameterTest, UseSimTimeSwitchesTheClock)
{
  const auto system_time = [] {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  EXPECT_FALSE(node.get_parameter<bool>("use_sim_time"));
  EXPECT_NEAR(static_cast<double>(node.now().sec), static_cast<double>(system_time()), 1.0);
  EXPECT_TRUE(node.set_parameter("use_sim_time", true));
  EXPECT_EQ(node.now(), builtin_interfaces::msg::Time());
  EXPECT_TRUE(node.set_parameter("use_sim_time", false));
  EXPECT_NEAR(static_cast<double>(node.now().sec), static_cast<double>(system_time()), 1.0);
}
