// The end of a command_server that was not closed before, as after an exception.
#include <cstdlib>

#include "goal_fixture.hpp"
#include "nodes/command_server.hpp"

namespace ur_ros_rtde::test {
namespace {

constexpr int plugin_destroyed = 3;  // exit code of plugins/exits_when_destroyed.cpp
constexpr int goal_left = 1;         // of exit_without()
constexpr int goal_could_not_be_started = 4;

/// The loopback address of this test. Nothing listens there.
std::string address()
{
  const char * given = std::getenv("UR_TEST_ADDRESS");
  return given != nullptr ? given : "127.14.3.9";
}

/// The processes of this test know its plugin.
void add_prefix_of_plugin()
{
  const char * before = std::getenv("AMENT_PREFIX_PATH");
  const std::string path = std::string(PREFIX) + (before != nullptr ? std::string(":") + before : "");
  ASSERT_EQ(::setenv("AMENT_PREFIX_PATH", path.c_str(), 1), 0);
}

/// Constructs a server with its plugin, and destroys it while its goal, if it `hangs`, has not ended.
void destroy_server(bool hangs)
{
  add_prefix_of_plugin();
  const auto context = std::make_shared<rcl_cxx::Context>(
      std::vector<std::string>{"command_server", "--ros-args", "-p", "robot_ip:=" + address(), "-p",
                               "plugins:=[exits_when_destroyed]"},
      rcl_cxx::InitOptions{.shutdown_on_signal = false});
  const Behavior behavior;
  CommandServer server(context);
  server.load_plugins();
  if (hangs) {
    const auto goal = std::make_shared<BehavingGoal>(server.host(), rcl_cxx::GoalUUID::random(), behavior);
    const Status started = server.host().goals().start(goal, [] {
      std::promise<void> never;
      never.get_future().wait();
    });
    if (!started) {
      std::_Exit(goal_could_not_be_started);
    }
  }
}

class CommandServerDeathTest : public testing::Test {
 protected:
  // The server has threads: each process begins anew.
  CommandServerDeathTest() { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

/// Otherwise the other test would not show that its plugin was kept.
TEST_F(CommandServerDeathTest, DestroysItsPlugins)
{
  EXPECT_EXIT(destroy_server(false), testing::ExitedWithCode(plugin_destroyed), "");
}

TEST_F(CommandServerDeathTest, KeepsItsPluginsIfAGoalDoesNotEnd)
{
  EXPECT_EXIT(destroy_server(true), testing::ExitedWithCode(goal_left),
              "goal /test .* did not end, the process exits without it");
}

}  // namespace
}  // namespace ur_ros_rtde::test
