#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <future>
#include <latch>
#include <thread>

#include "rcl_cxx/rcl_cxx.hpp"
#include "ros_fixture.hpp"

using rcl_cxx::Context;
using rcl_cxx::InitOptions;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {
std::string error_of(const std::function<void()> & action)
{
  try {
    action();
  } catch (const rcl_cxx::Error & error) {
    return error.what();
  }
  return "no exception";
}
}  // namespace

TEST(ContextArgumentsTest, ReturnsNonRosArguments)
{
  const auto context = make_context({"--speed", "1", "--ros-args", "-r", "a:=b", "--", "rest"});
  EXPECT_THAT(context->non_ros_arguments(), ElementsAre("test", "--speed", "1", "rest"));
}

TEST(ContextArgumentsTest, NamesUnknownRosArguments)
{
  EXPECT_THAT(error_of([] { make_context({"--ros-args", "--sped", "1"}); }),
              HasSubstr("unknown ROS arguments: --sped 1"));
}

TEST(ContextArgumentsTest, NamesMalformedRosArguments)
{
  EXPECT_THAT(error_of([] { make_context({"--ros-args", "-r", "no remap"}); }), HasSubstr("no remap"));
  EXPECT_THAT(error_of([] { make_context({"--ros-args", "--params-file", "/does/not/exist.yaml"}); }),
              HasSubstr("/does/not/exist.yaml"));
}

TEST(ContextShutdownTest, HappensOnceAndKeepsItsReason)
{
  const auto context = make_context();
  EXPECT_TRUE(context->ok());
  EXPECT_FALSE(context->wait_for_shutdown(std::chrono::milliseconds(1)));
  EXPECT_TRUE(context->shutdown("first"));
  EXPECT_FALSE(context->shutdown("second"));
  EXPECT_FALSE(context->ok());
  EXPECT_EQ(context->shutdown_reason(), "first");
  EXPECT_TRUE(context->wait_for_shutdown(std::chrono::seconds(0)));
}

TEST(ContextShutdownTest, HappensOnceIfTwoThreadsAskForIt)
{
  for (int round = 0; round < 50; ++round) {
    const auto context = make_context();
    std::atomic<int> callbacks{0};
    std::atomic<int> succeeded{0};
    context->add_pre_shutdown_callback([&] { ++callbacks; });
    std::latch together(2);
    const auto shut_down = [&] {
      together.arrive_and_wait();
      succeeded += context->shutdown("of two") ? 1 : 0;
    };
    std::thread other(shut_down);
    shut_down();
    other.join();
    EXPECT_EQ(succeeded, 1);
    EXPECT_EQ(callbacks, 1);
  }
}

TEST(ContextShutdownTest, RunsCallbacksInOrder)
{
  const auto context = make_context();
  std::vector<std::string> calls;
  context->add_on_shutdown_callback([&] { calls.push_back("after"); });
  context->add_pre_shutdown_callback([&] { calls.push_back(context->ok() ? "still ok" : "before 1"); });
  context->add_pre_shutdown_callback([&] { throw std::runtime_error("is logged"); });
  const auto removed = context->add_pre_shutdown_callback([&] { calls.push_back("removed"); });
  context->add_pre_shutdown_callback([&] { calls.push_back("before 2"); });
  context->remove_shutdown_callback(removed);
  context->shutdown("test");
  context->add_on_shutdown_callback([&] { calls.push_back("late"); });
  EXPECT_THAT(calls, ElementsAre("before 1", "before 2", "after", "late"));
}

TEST(ContextShutdownTest, WakesWaitersForItsBeginBeforeItsEnd)
{
  const auto context = make_context();
  std::promise<void> go_on;
  context->add_pre_shutdown_callback([&] { go_on.get_future().wait_for(kLimit); });
  auto done = std::async(std::launch::async, [&] { context->shutdown("test"); });
  EXPECT_TRUE(context->wait_for_shutdown_begin(kLimit));
  EXPECT_FALSE(context->wait_for_shutdown(std::chrono::milliseconds(5)));
  go_on.set_value();
  EXPECT_TRUE(context->wait_for_shutdown(kLimit));
}

TEST(ContextShutdownTest, LeavesOtherContextsAlone)
{
  const auto one = make_context();
  const auto other = make_context();
  one->shutdown("test");
  EXPECT_TRUE(other->ok());
  EXPECT_NO_THROW(rcl_cxx::Node(other, "node"));
}

TEST(ContextShutdownTest, LaterLogMessagesGoToTheConsoleOnly)
{
  const auto context = make_context();
  const rcl_cxx::Node node(context, "node");
  context->shutdown("test");
  testing::internal::CaptureStderr();
  RCL_CXX_INFO(node.get_logger(), "a late message");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("a late message"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST(ContextShutdownTest, PreventsNewNodes)
{
  const auto context = make_context();
  context->shutdown("test");
  EXPECT_THAT(error_of([&] { rcl_cxx::Node(context, "node"); }), HasSubstr("node 'node'"));
}

TEST(NodeNameTest, NamesInvalidName)
{
  const auto context = make_context();
  EXPECT_THAT(error_of([&] { rcl_cxx::Node(context, "my-node"); }), HasSubstr("'my-node'"));
  EXPECT_THAT(error_of([&] { rcl_cxx::Node(context, "node", "bad space"); }), HasSubstr("'bad space'"));
}

TEST(NodeNameTest, FollowsNamespaceAndRemaps)
{
  const auto context =
      make_context({"--ros-args", "-r", "__ns:=/left", "-r", "chatter:=talk", "-r", "__node:=arm"});
  const rcl_cxx::Node node(context, "node", "/robot");
  EXPECT_EQ(node.get_fully_qualified_name(), "/left/arm");
  EXPECT_EQ(node.get_name(), "arm");
  EXPECT_EQ(node.get_namespace(), "/left");
  EXPECT_EQ(node.resolve_topic_name("chatter"), "/left/talk");
  EXPECT_EQ(node.resolve_topic_name("~/state"), "/left/arm/state");
  EXPECT_EQ(node.resolve_service_name("/absolute"), "/absolute");
  EXPECT_THAT(error_of([&] { node.resolve_topic_name("not valid"); }), HasSubstr("'not valid'"));
}

TEST(SignalHandlerTest, IsRestoredWithTheLastContext)
{
  struct sigaction before = {};
  struct sigaction during = {};
  struct sigaction after = {};
  ::sigaction(SIGTERM, nullptr, &before);
  {
    const Context context(std::vector<std::string>{"test"});
    ::sigaction(SIGTERM, nullptr, &during);
  }
  ::sigaction(SIGTERM, nullptr, &after);
  EXPECT_NE(before.sa_handler, during.sa_handler);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}
