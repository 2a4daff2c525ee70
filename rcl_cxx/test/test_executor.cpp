#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <std_msgs/msg/string.hpp>

#include "rcl_cxx/rcl_cxx.hpp"
#include "ros_fixture.hpp"

using std_msgs::msg::String;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {
constexpr std::chrono::milliseconds kPeriod{5};

using ExecutorTaskTest = InThread;
using ExecutorCancelTest = InThread;
using ExecutorNodeTest = InThread;
using TimerTest = InThread;
}  // namespace

TEST_F(ExecutorTaskTest, RunsInOrderOfPosting)
{
  std::vector<int> order;
  for (int i = 0; i < 5; ++i) {
    executor.post([&, i] { order.push_back(i); });
  }
  EXPECT_TRUE(executor.spin_until([&] { return order.size() == 5; }, kLimit));
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(ExecutorTaskTest, DoesNotEndTheSpinWhenItThrows)
{
  bool reached = false;
  executor.post([] { throw std::runtime_error("is logged"); });
  executor.post([] { throw 42; });
  executor.post([&] { reached = true; });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
}

TEST_F(ExecutorTaskTest, MayPostTasksButNotSpin)
{
  bool reached = false;
  std::string error;
  executor.post([&] {
    try {
      executor.spin();
    } catch (const rcl_cxx::Error & e) {
      error = e.what();
    }
    executor.post([&] { reached = true; });
  });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
  EXPECT_THAT(error, HasSubstr("spinning already"));
}

TEST_F(ExecutorCancelTest, IsNotLostBeforeSpin)
{
  executor.cancel();
  executor.spin();  // returns at once
  bool ran = false;
  executor.post([&] { ran = true; });
  EXPECT_TRUE(executor.spin_until([&] { return ran; }, kLimit)) << "one cancel cancels one spin";
}

TEST_F(ExecutorCancelTest, LeavesRemainingEventsForTheNextSpin)
{
  int count = 0;
  executor.post([&] {
    ++count;
    executor.cancel();
  });
  executor.post([&] { ++count; });
  std::thread([&] { executor.spin(); }).join();
  EXPECT_EQ(count, 1);
  EXPECT_TRUE(executor.spin_until([&] { return count == 2; }, kLimit));
}

TEST_F(ExecutorCancelTest, HappensAtShutdown)
{
  auto spinning = std::async(std::launch::async, [&] { executor.spin(); });
  context->shutdown("test");
  ASSERT_EQ(spinning.wait_for(kLimit), std::future_status::ready);
  EXPECT_FALSE(executor.spin_until([] { return false; }, kLimit)) << "returns at once";
}

TEST_F(ExecutorCancelTest, HappensAtTimeout)
{
  EXPECT_FALSE(executor.spin_until([] { return false; }, kPeriod));
}

TEST_F(ExecutorNodeTest, BelongsToOneExecutor)
{
  rcl_cxx::Executor other(context);
  EXPECT_THROW(other.add_node(node), rcl_cxx::Error);
  EXPECT_THROW(executor.add_node(node), rcl_cxx::Error);
}

TEST_F(ExecutorNodeTest, KeepsEventsUntilItHasAnExecutor)
{
  rcl_cxx::Node late(context, "late");
  std::vector<std::string> heard;
  const auto subscription = late.create_subscription<String>(
      "topic", rcl_cxx::QoS::reliable(10), [&](const String & message) { heard.push_back(message.data); });
  const auto publisher = node.create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  for (const char * text : {"a", "b"}) {
    String message;
    message.data = text;
    publisher->publish(message);
  }
  executor.add_node(late);
  EXPECT_TRUE(executor.spin_until([&] { return heard.size() == 2; }, kLimit));
  EXPECT_THAT(heard, ElementsAre("a", "b"));
}

TEST_F(TimerTest, KeepsItsRateWithoutDrift)
{
  std::vector<std::chrono::steady_clock::time_point> calls;
  const auto start = std::chrono::steady_clock::now();
  const auto timer =
      node.create_wall_timer(kPeriod, [&] { calls.push_back(std::chrono::steady_clock::now()); });
  ASSERT_TRUE(executor.spin_until([&] { return calls.size() == 50; }, kLimit));
  // No call is early, and all due times are start + n * period, even if single calls are late.
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_GE(calls[i] - start, kPeriod * (i + 1));
  }
}

TEST_F(TimerTest, SkipsMissedPeriods)
{
  std::vector<std::chrono::steady_clock::time_point> calls;
  const auto start = std::chrono::steady_clock::now();
  const auto timer = node.create_wall_timer(kPeriod, [&] {
    calls.push_back(std::chrono::steady_clock::now());
    if (calls.size() == 1) {
      std::this_thread::sleep_for(10 * kPeriod);
    }
  });
  ASSERT_TRUE(executor.spin_until([&] { return calls.size() == 5; }, kLimit));
  // The second call stands for all missed periods; the others are at their due times.
  EXPECT_GE(calls[1] - start, 11 * kPeriod);
  EXPECT_GE(calls[4] - start, 14 * kPeriod);
}

TEST_F(TimerTest, StopsWhenCanceledAndRestartsWhenReset)
{
  int calls = 0;
  std::shared_ptr<rcl_cxx::Timer> timer;
  timer = node.create_wall_timer(kPeriod, [&] {
    ++calls;
    timer->cancel();
  });
  EXPECT_TRUE(executor.spin_until([&] { return calls == 1; }, kLimit));
  EXPECT_TRUE(timer->is_canceled());
  EXPECT_FALSE(executor.spin_until([&] { return calls > 1; }, 4 * kPeriod));
  timer->reset();
  EXPECT_FALSE(timer->is_canceled());
  EXPECT_TRUE(executor.spin_until([&] { return calls == 2; }, kLimit));
}

TEST_F(TimerTest, NeverRunsWhenResetInTime)
{
  int calls = 0;
  const auto watchdog = node.create_wall_timer(std::chrono::hours(1), [&] { ++calls; });
  int fed = 0;
  const auto feeder = node.create_wall_timer(std::chrono::milliseconds(1), [&] {
    for (int i = 0; i < 100; ++i, ++fed) {
      watchdog->reset();
    }
  });
  EXPECT_TRUE(executor.spin_until([&] { return fed >= 1000; }, kLimit));
  EXPECT_EQ(calls, 0);
}

TEST_F(TimerTest, NeedsPositivePeriod)
{
  EXPECT_THROW(node.create_wall_timer(std::chrono::seconds(-1), [] {}), rcl_cxx::Error);
  EXPECT_THROW(node.create_wall_timer(std::chrono::seconds(0), [] {}), rcl_cxx::Error);
}

TEST_F(TimerTest, DoesNotStarveEvents)
{
  const auto timer = node.create_wall_timer(std::chrono::nanoseconds(1), [] {});
  bool reached = false;
  executor.post([&] { reached = true; });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
}

TEST_F(TimerTest, MayDestroyItselfInItsCallback)
{
  int calls = 0;
  std::shared_ptr<rcl_cxx::Timer> timer;
  timer = node.create_wall_timer(kPeriod, [&] {
    ++calls;
    timer.reset();
  });
  EXPECT_TRUE(executor.spin_until([&] { return calls == 1; }, kLimit));
  EXPECT_FALSE(executor.spin_until([&] { return calls > 1; }, 4 * kPeriod));
}

using SpinningExecutorTest = Spinning;

TEST_F(SpinningExecutorTest, NeverRunsTwoCallbacksAtOnce)
{
  std::atomic<int> inside{0};
  std::atomic<bool> overlapped{false};
  const auto callback = [&](std::atomic<int> & calls) {
    return [&] {
      overlapped = overlapped || ++inside != 1;
      std::this_thread::yield();
      --inside;
      ++calls;
    };
  };
  std::atomic<int> timed{0};
  std::atomic<int> posted{0};
  const auto one = node->create_wall_timer(std::chrono::milliseconds(1), callback(timed));
  const auto two = node->create_wall_timer(std::chrono::milliseconds(1), callback(timed));
  std::thread poster([&] {
    for (int i = 0; i < 200; ++i) {
      executor->post(callback(posted));
    }
  });
  poster.join();
  // Posted tasks refer to this function and cannot be removed: wait for all of them.
  ASSERT_TRUE(eventually([&] { return posted == 200 && timed > 50; }));
  EXPECT_FALSE(overlapped);
}

TEST_F(SpinningExecutorTest, AllowsCreationAndDestructionInOtherThreads)
{
  std::atomic<int> heard{0};
  std::atomic<bool> done{false};
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  std::thread talker([&] {
    String message;
    while (!done) {
      publisher->publish(message);
    }
  });
  for (int round = 0; round < 30; ++round) {
    auto alive = std::make_shared<std::atomic<bool>>(true);
    auto subscription = node->create_subscription<String>(
        "topic", rcl_cxx::QoS::reliable(10), [&heard, alive](const String &) {
          EXPECT_TRUE(*alive) << "a callback ran after its subscription was destroyed";
          ++heard;
        });
    auto timer = node->create_wall_timer(std::chrono::milliseconds(1), [alive] { EXPECT_TRUE(*alive); });
    const int before = heard;
    EXPECT_TRUE(eventually([&] { return heard > before; }));
    timer.reset();
    subscription.reset();
    *alive = false;
  }
  done = true;
  talker.join();
}

TEST_F(SpinningExecutorTest, AllowsCreationAndDestructionInCallbacks)
{
  std::shared_ptr<rcl_cxx::Subscription<String>> subscription;
  std::atomic<int> destroyed{0};
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  std::function<void()> subscribe = [&] {
    subscription =
        node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(10), [&](const String &) {
          subscription.reset();
          if (++destroyed < 5) {
            subscribe();
          }
        });
  };
  executor->post(subscribe);
  const auto timer =
      node->create_wall_timer(std::chrono::milliseconds(1), [&] { publisher->publish(String()); });
  EXPECT_TRUE(eventually([&] { return destroyed == 5; }));
}

TEST_F(SpinningExecutorTest, AllowsNodesToComeAndGo)
{
  for (int round = 0; round < 5; ++round) {
    auto other = std::make_shared<rcl_cxx::Node>(context, "other");
    std::atomic<int> calls{0};
    auto timer = other->create_wall_timer(std::chrono::milliseconds(1), [&] { ++calls; });
    executor->add_node(other);
    EXPECT_TRUE(eventually([&] { return calls > 2; }));
    timer.reset();
  }
}

TEST_F(SpinningExecutorTest, ServesTimersThatOutliveTheirNode)
{
  std::atomic<int> calls{0};
  auto other = std::make_unique<rcl_cxx::Node>(context, "other");
  executor->add_node(*other);
  const auto timer = other->create_wall_timer(std::chrono::milliseconds(1), [&] { ++calls; });
  other.reset();
  const int before = calls;
  EXPECT_TRUE(eventually([&] { return calls > before; }));
}

TEST_F(SpinningExecutorTest, RejectsSecondSpinningThread)
{
  std::promise<void> spins;
  executor->post([&] { spins.set_value(); });
  ASSERT_EQ(spins.get_future().wait_for(kLimit), std::future_status::ready);
  EXPECT_THROW(executor->spin(), rcl_cxx::Error);
}
