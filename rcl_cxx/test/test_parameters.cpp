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

TEST(ParameterOverrides, of_the_command_line_win_over_the_default)
{
  const auto context =
      make_context({"--ros-args", "-p", "speed:=0.25", "-p", "host:=robot", "-p", "other:speed:=9.0"});
  Node node(context, "node");
  EXPECT_EQ(node.declare_parameter("speed", 1.0), 0.25);
  EXPECT_EQ(node.declare_parameter("host", "localhost"), "robot");
  EXPECT_EQ(node.declare_parameter("untouched", 3), 3);
}

TEST(ParameterOverrides, of_integers_serve_as_floating_point_numbers)
{
  const auto context = make_context({"--ros-args", "-p", "speed:=1", "-p", "home:=[1, 2]"});
  Node node(context, "node");
  EXPECT_EQ(node.declare_parameter("speed", 0.5), 1.0);
  EXPECT_THAT(node.declare_parameter<std::vector<double>>("home", {}), ElementsAre(1.0, 2.0));
}

TEST(ParameterOverrides, of_a_wrong_type_or_out_of_range_are_refused_at_the_declaration)
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

TEST(ParameterOverrides, may_be_ignored)
{
  const auto context = make_context({"--ros-args", "-p", "speed:=0.25"});
  Node node(context, "node");
  EXPECT_EQ(node.declare_parameter("speed", 1.0, {.ignore_override = true}), 1.0);
}

TEST(ParameterOverrides, come_from_files_by_node_name)
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

TEST(ParameterOverrides, of_the_node_win_over_all_others)
{
  const auto context = make_context({"--ros-args", "-p", "a:=1", "-p", "b:=1", "-p", "c:=1"});
  Node node(
      context, "node", "",
      {.arguments = {"--ros-args", "-p", "b:=2", "-p", "c:=2"}, .parameter_overrides = {Parameter{"c", 3}}});
  EXPECT_EQ(node.declare_parameter("a", 0), 1);
  EXPECT_EQ(node.declare_parameter("b", 0), 2);
  EXPECT_EQ(node.declare_parameter("c", 0), 3);
}

TEST(ParameterOverrides, may_be_declared_all_at_once)
{
  const auto context = make_context({"--ros-args", "-p", "a:=1"});
  Node node(context, "node", "", {.automatically_declare_parameters_from_overrides = true});
  EXPECT_EQ(node.get_parameter<int>("a"), 1);
}

class Parameters : public testing::Test {
 protected:
  std::shared_ptr<rcl_cxx::Context> context = make_context();
  Node node{context, "node"};
};

TEST_F(Parameters, are_declared_once)
{
  node.declare_parameter("a", 1);
  EXPECT_THAT(error_of([&] { node.declare_parameter("a", 1); }), HasSubstr("'a' is declared already"));
  EXPECT_THAT(error_of([&] { node.declare_parameter("", 1); }), HasSubstr("needs a name"));
  EXPECT_THAT(error_of([&] { node.declare_parameter("b", {}); }), HasSubstr("'b' has neither a default"));
}

TEST_F(Parameters, are_unknown_until_declared)
{
  EXPECT_FALSE(node.has_parameter("a"));
  EXPECT_THAT(error_of([&] { node.get_parameter("a"); }), HasSubstr("'a' is not declared"));
  EXPECT_THAT(node.set_parameter("a", 1).error(), HasSubstr("'a' cannot be set because it was not declared"));
  node.declare_parameter("a", 1);
  EXPECT_TRUE(node.has_parameter("a"));
  EXPECT_EQ(node.get_parameter<int>("a"), 1);
}

TEST_F(Parameters, have_limits_that_their_default_must_keep)
{
  const rcl_cxx::ParameterDescriptor options{.integer_range = rcl_cxx::IntegerRange{0, 10}};
  EXPECT_THAT(error_of([&] { node.declare_parameter("n", 11, options); }), HasSubstr("range 0 to 10"));
  node.declare_parameter("n", 5, options);
  EXPECT_FALSE(node.set_parameter("n", -1));
  EXPECT_TRUE(node.set_parameter("n", 10));
  EXPECT_EQ(node.get_parameter<int>("n"), 10);
}

TEST_F(Parameters, that_are_read_only_stay)
{
  node.declare_parameter("model", "ur5e", {.read_only = true});
  EXPECT_THAT(node.set_parameter("model", "ur10e").error(), HasSubstr("read-only"));
}

TEST_F(Parameters, are_set_all_or_none)
{
  node.declare_parameter("a", 1);
  node.declare_parameter("b", 1);
  EXPECT_FALSE(node.set_parameters_atomically({{"a", 2}, {"b", "text"}}));
  EXPECT_EQ(node.get_parameter<int>("a"), 1);
  EXPECT_TRUE(node.set_parameters_atomically({{"a", 2}, {"b", 3}}));
  EXPECT_EQ(node.get_parameter<int>("b"), 3);
}

TEST_F(Parameters, of_dynamic_type_change_it_and_can_go)
{
  node.declare_parameter("any", 1, {.dynamic_typing = true});
  EXPECT_TRUE(node.set_parameter("any", "text"));
  EXPECT_EQ(node.get_parameter<std::string>("any"), "text");
  EXPECT_TRUE(node.set_parameter("any", {}));
  EXPECT_FALSE(node.has_parameter("any"));
  node.declare_parameter("any", 1, {.dynamic_typing = true});
  node.undeclare_parameter("any");
  EXPECT_FALSE(node.has_parameter("any"));
  node.declare_parameter("fixed", 1);
  EXPECT_THAT(error_of([&] { node.undeclare_parameter("fixed"); }), HasSubstr("statically typed"));
}

TEST_F(Parameters, ask_their_callbacks_and_tell_them)
{
  node.declare_parameter("a", 1);
  std::vector<Parameter> told;
  auto guard = node.add_on_set_parameters_callback(
      [](const std::vector<Parameter> & parameters) -> rcl_cxx::SetParametersResult {
        if (parameters.at(0).value.get<int>() == 7) {
          return tl::make_unexpected(std::string("7 is not liked"));
        }
        return {};
      });
  auto listener = node.add_post_set_parameters_callback(
      [&](const std::vector<Parameter> & parameters) { told = parameters; });
  EXPECT_EQ(node.set_parameter("a", 7).error(), "7 is not liked");
  EXPECT_TRUE(told.empty());
  EXPECT_TRUE(node.set_parameter("a", 8));
  EXPECT_THAT(told, ElementsAre(Parameter{"a", 8}));
  EXPECT_THAT(error_of([&] { node.declare_parameter("b", 7); }), HasSubstr("7 is not liked"));
  guard.reset();
  EXPECT_TRUE(node.set_parameter("a", 7));
}

TEST_F(Parameters, refuse_what_a_callback_throws_or_sets)
{
  node.declare_parameter("a", 1);
  std::string error;
  auto setter = node.add_on_set_parameters_callback(
      [&](const std::vector<Parameter> &) -> rcl_cxx::SetParametersResult {
        error = node.set_parameter("a", 5).error();
        throw std::runtime_error("the callback failed");
      });
  EXPECT_EQ(node.set_parameter("a", 2).error(), "the callback failed");
  EXPECT_THAT(error, HasSubstr("cannot be declared or set from a parameter callback"));
  EXPECT_EQ(node.get_parameter<int>("a"), 1);
}

TEST_F(Parameters, include_those_of_every_node)
{
  EXPECT_FALSE(node.get_parameter<bool>("use_sim_time"));
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  EXPECT_LT(std::abs(node.now_ns() - now.count()), 1'000'000'000);
  EXPECT_TRUE(node.set_parameter("use_sim_time", true));
  EXPECT_EQ(node.now_ns(), 0);
  EXPECT_TRUE(node.set_parameter("use_sim_time", false));
  EXPECT_GT(node.now_ns(), now.count());
}
