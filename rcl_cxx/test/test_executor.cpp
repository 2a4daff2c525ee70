#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <std_msgs/msg/string.hpp>

#include "../src/response_retry.hpp"
#include "rcl_cxx/rcl_cxx.hpp"
#include "ros_fixture.hpp"

using std_msgs::msg::String;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {
constexpr std::chrono::milliseconds kPeriod{5};

/// An executor in the test's own thread.
class InThread : public ::testing::Test {
 protected:
  InThread() { executor.add_node(node); }

  std::shared_ptr<rcl_cxx::Context> context = make_context();
  rcl_cxx::Node node{context, "node"};
  rcl_cxx::Executor executor{context};
};
using ExecutorTasks = InThread;
using ExecutorStop = InThread;
using ExecutorNodes = InThread;
using Timers = InThread;
}  // namespace

TEST_F(ExecutorTasks, run_in_the_order_of_their_posting)
{
  std::vector<int> order;
  for (int i = 0; i < 5; ++i) {
    executor.post([&, i] { order.push_back(i); });
  }
  EXPECT_TRUE(executor.spin_until([&] { return order.size() == 5; }, kLimit));
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(ExecutorTasks, that_throw_do_not_end_the_spinning)
{
  bool reached = false;
  executor.post([] { throw std::runtime_error("is logged"); });
  executor.post([] { throw 42; });
  executor.post([&] { reached = true; });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
}

TEST_F(ExecutorTasks, may_post_further_ones_but_not_spin)
{
  bool reached = false;
  std::string error;
  executor.post([&] {
    EXPECT_TRUE(executor.in_callback_thread());
    try {
      executor.spin();
    } catch (const rcl_cxx::Error & e) {
      error = e.what();
    }
    executor.post([&] { reached = true; });
  });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
  EXPECT_THAT(error, HasSubstr("spinning already"));
  EXPECT_FALSE(executor.in_callback_thread());
}

TEST_F(ExecutorStop, before_the_spin_is_not_lost)
{
  executor.cancel();
  executor.spin();  // would not return
  bool ran = false;
  executor.post([&] { ran = true; });
  EXPECT_TRUE(executor.spin_until([&] { return ran; }, kLimit)) << "one stop stops once";
}

TEST_F(ExecutorStop, ends_a_spin_in_another_thread_and_leaves_the_rest_for_the_next)
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

TEST_F(ExecutorStop, comes_with_the_shutdown_of_the_context)
{
  auto spinning = std::async(std::launch::async, [&] { executor.spin(); });
  context->shutdown("test");
  ASSERT_EQ(spinning.wait_for(kLimit), std::future_status::ready);
  EXPECT_FALSE(executor.spin_until([] { return false; }, kLimit)) << "returns at once";
}

TEST_F(ExecutorStop, of_a_wait_for_a_condition_comes_with_its_time)
{
  EXPECT_FALSE(executor.spin_until([] { return false; }, kPeriod));
  executor.spin_for(kPeriod);
}

TEST_F(ExecutorNodes, belong_to_one_executor_at_a_time)
{
  rcl_cxx::Executor other(context);
  EXPECT_THROW(other.add_node(node), rcl_cxx::Error);
  executor.remove_node(node);
  other.add_node(node);
  bool called = false;
  const auto timer = node.create_wall_timer(kPeriod, [&] { called = true; });
  EXPECT_FALSE(executor.spin_until([&] { return called; }, 3 * kPeriod));
  EXPECT_TRUE(other.spin_until([&] { return called; }, kLimit));
}

TEST_F(ExecutorNodes, keep_what_arrives_until_an_executor_comes)
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

TEST_F(Timers, keep_their_rate_without_drift)
{
  std::vector<std::chrono::steady_clock::time_point> calls;
  const auto start = std::chrono::steady_clock::now();
  const auto timer =
      node.create_wall_timer(kPeriod, [&] { calls.push_back(std::chrono::steady_clock::now()); });
  ASSERT_TRUE(executor.spin_until([&] { return calls.size() == 50; }, kLimit));
  // None may come before its time, and all times are multiples of the period from the start: however late
  // single calls are on a busy machine, the phase stays.
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_GE(calls[i] - start, kPeriod * (i + 1));
  }
}

TEST_F(Timers, skip_the_periods_they_have_missed)
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
  // The second makes good for all that were missed, the others wait for their time.
  EXPECT_GE(calls[1] - start, 11 * kPeriod);
  EXPECT_GE(calls[4] - start, 14 * kPeriod);
}

TEST_F(Timers, stop_when_canceled_and_go_on_when_reset)
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

TEST_F(Timers, that_are_reset_in_time_never_run)
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

TEST_F(Timers, follow_a_changed_period)
{
  int calls = 0;
  const auto timer = node.create_wall_timer(std::chrono::hours(1), [&] { ++calls; });
  timer->set_period(kPeriod);
  EXPECT_EQ(timer->period(), kPeriod);
  EXPECT_TRUE(executor.spin_until([&] { return calls == 2; }, kLimit));
  EXPECT_THROW(timer->set_period(std::chrono::seconds(0)), rcl_cxx::Error);
  EXPECT_THROW(node.create_wall_timer(std::chrono::seconds(-1), [] {}), rcl_cxx::Error);
}

TEST_F(Timers, do_not_starve_events)
{
  const auto timer = node.create_wall_timer(std::chrono::nanoseconds(1), [] {});
  bool reached = false;
  executor.post([&] { reached = true; });
  EXPECT_TRUE(executor.spin_until([&] { return reached; }, kLimit));
}

TEST_F(Timers, may_destroy_themselves_in_their_callback)
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

using WhileSpinning = Spinning;

class Answers : public InThread {
 protected:
  std::shared_ptr<rcl_cxx::detail::ResponseRetry> answers =
      std::make_shared<rcl_cxx::detail::ResponseRetry>(node.impl());
  int attempts = 0;
  std::vector<rcl_ret_t> done;
};

TEST_F(Answers, are_done_with_at_once_when_their_client_is_known)
{
  answers->send([&] { return ++attempts, RCL_RET_OK; }, [&](rcl_ret_t code) { done.push_back(code); });
  EXPECT_EQ(attempts, 1);
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(Answers, are_tried_again_until_their_client_is_known)
{
  answers->send([&] { return ++attempts < 3 ? RCL_RET_TIMEOUT : RCL_RET_OK; },
                [&](rcl_ret_t code) { done.push_back(code); });
  EXPECT_TRUE(done.empty());
  answers->send([] { return RCL_RET_TIMEOUT; }, [](rcl_ret_t) {});
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, kLimit));
  EXPECT_EQ(attempts, 3);
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(Answers, are_given_up_in_the_end)
{
  answers->send([&] { return ++attempts, RCL_RET_TIMEOUT; }, [&](rcl_ret_t code) { done.push_back(code); });
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, 2 * kLimit));
  EXPECT_GT(attempts, 5);
  EXPECT_THAT(done, ElementsAre(RCL_RET_TIMEOUT));
}

TEST_F(Answers, are_not_tried_after_the_end)
{
  answers->send([&] { return ++attempts, RCL_RET_TIMEOUT; }, [&](rcl_ret_t code) { done.push_back(code); });
  answers->stop();
  EXPECT_FALSE(executor.spin_until([&] { return attempts > 1; }, std::chrono::milliseconds(200)));
  EXPECT_TRUE(done.empty());
}

TEST_F(WhileSpinning, callbacks_never_overlap)
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
  // All of the posted ones, which refer to this function: nothing takes them back.
  ASSERT_TRUE(eventually([&] { return posted == 200 && timed > 50; }));
  EXPECT_FALSE(overlapped);
}

TEST_F(WhileSpinning, entities_come_and_go_in_other_threads)
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

TEST_F(WhileSpinning, entities_come_and_go_in_callbacks)
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

TEST_F(WhileSpinning, whole_nodes_come_and_go)
{
  for (int round = 0; round < 5; ++round) {
    auto other = std::make_shared<rcl_cxx::Node>(context, "other");
    std::atomic<int> calls{0};
    auto timer = other->create_wall_timer(std::chrono::milliseconds(1), [&] { ++calls; });
    executor->add_node(other);
    EXPECT_TRUE(eventually([&] { return calls > 2; }));
    executor->remove_node(*other);
    timer.reset();
  }
}

TEST_F(WhileSpinning, an_entity_outlives_its_node_object)
{
  std::atomic<int> calls{0};
  auto other = std::make_unique<rcl_cxx::Node>(context, "other");
  executor->add_node(*other);
  const auto timer = other->create_wall_timer(std::chrono::milliseconds(1), [&] { ++calls; });
  other.reset();
  const int before = calls;
  EXPECT_TRUE(eventually([&] { return calls > before; }));
}

TEST_F(WhileSpinning, a_second_thread_may_not_spin)
{
  std::promise<void> spins;
  executor->post([&] { spins.set_value(); });
  ASSERT_EQ(spins.get_future().wait_for(kLimit), std::future_status::ready);
  EXPECT_THROW(executor->spin(), rcl_cxx::Error);
}
