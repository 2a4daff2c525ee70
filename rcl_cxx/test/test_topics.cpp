#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <map>
#include <mutex>
#include <set>
#include <std_msgs/msg/string.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <test_msgs/msg/basic_types.hpp>

#include "counting_new.hpp"
#include "failing_publish.hpp"
#include "rcl_cxx/rcl_cxx.hpp"
#include "rcl_cxx_test/client.hpp"
#include "rcl_support/rcl_compat.hpp"
#include "ros_fixture.hpp"

using std_msgs::msg::String;
using std_srvs::srv::SetBool;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {
using TopicTest = Spinning;
using ServiceTest = Spinning;

String text(const std::string & data)
{
  String message;
  message.data = data;
  return message;
}
}  // namespace

TEST_F(TopicTest, KeepsOrderOfMessages)
{
  std::vector<std::string> heard;
  std::promise<void> all;
  const auto subscription =
      node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(100), [&](const String & message) {
        heard.push_back(message.data);
        if (heard.size() == 3) {
          all.set_value();
        }
      });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(100));
  EXPECT_EQ(publisher->get_topic_name(), "/test/topic");
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  EXPECT_EQ(subscription->get_topic_name(), "/test/topic");
  publisher->publish(text("a"));
  publisher->publish(text("b"));
  publisher->publish(text("c"));
  ASSERT_EQ(all.get_future().wait_for(kLimit), std::future_status::ready);
  EXPECT_THAT(heard, ElementsAre("a", "b", "c"));
}

TEST_F(TopicTest, TransientLocalReachesLateSubscriber)
{
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::transient_local());
  publisher->publish(text("from before"));
  std::promise<std::string> heard;
  const auto subscription =
      node->create_subscription<String>("topic", rcl_cxx::QoS::transient_local(),
                                        [&](const String & message) { heard.set_value(message.data); });
  auto future = heard.get_future();
  ASSERT_EQ(future.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(future.get(), "from before");
}

TEST_F(TopicTest, MessagesCanBeTakenWithoutAnExecutor)
{
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::transient_local(2));
  publisher->publish(text("first"));
  publisher->publish(text("second"));
  rcl_cxx::Node without_executor(context, "other", "/test");
  const auto subscription = without_executor.create_subscription<String>(
      "topic", rcl_cxx::QoS::transient_local(2), [](const String &) { ADD_FAILURE() << "has no executor"; });
  String message;
  ASSERT_TRUE(eventually([&] { return subscription->take(message); }));
  EXPECT_EQ(message.data, "first");
  ASSERT_TRUE(eventually([&] { return subscription->take(message); }));
  EXPECT_EQ(message.data, "second");
  EXPECT_FALSE(subscription->take(message));
}

TEST_F(TopicTest, GivesMessagesThatCanBeKept)
{
  std::mutex mutex;
  std::vector<std::shared_ptr<const String>> kept;
  const auto subscription = node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(100),
                                                              [&](std::shared_ptr<const String> message) {
                                                                const std::lock_guard lock(mutex);
                                                                kept.push_back(std::move(message));
                                                              });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(100));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  publisher->publish(text("a"));
  publisher->publish(text("b"));
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return kept.size() == 2;
  }));
  EXPECT_EQ(kept[0]->data, "a");
  EXPECT_EQ(kept[1]->data, "b");
}

TEST_F(TopicTest, SurvivesThrowingCallback)
{
  std::atomic<int> calls{0};
  const auto subscription =
      node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(10), [&](const String & message) {
        ++calls;
        if (message.data == "bad") {
          throw std::runtime_error("is logged");
        }
      });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  publisher->publish(text("bad"));
  publisher->publish(text("good"));
  EXPECT_TRUE(eventually([&] { return calls == 2; }));
}

TEST_F(TopicTest, PublishesWithoutAllocation)
{
  // Without a subscription the middleware does not serialize: only this layer and rcl could allocate.
  const auto publisher =
      node->create_publisher<test_msgs::msg::BasicTypes>("alone", rcl_cxx::QoS::reliable(10));
  const test_msgs::msg::BasicTypes message;
  publisher->publish(message);
  const std::size_t before = allocations_of_this_thread();
  for (int i = 0; i < 1000; ++i) {
    publisher->publish(message);
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST_F(TopicTest, TellsPublishersApart)
{
  std::mutex mutex;
  std::map<std::string, std::set<rcl_cxx::PublisherId>> publishers;  // by text
  const auto subscription = node->create_subscription<String>(
      "topic", rcl_cxx::QoS::reliable(10), [&](const String & message, const rcl_cxx::MessageInfo & info) {
        const std::lock_guard lock(mutex);
        publishers[message.data].insert(info.publisher);
      });
  const auto one = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  const auto other = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(
      eventually([&] { return one->get_subscription_count() == 1 && other->get_subscription_count() == 1; }));
  for (int i = 0; i < 3; ++i) {
    one->publish(text("one"));
    other->publish(text("other"));
  }
  one->publish(text("end"));
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return publishers.contains("end") && publishers.contains("other");
  }));
  EXPECT_EQ(publishers["one"].size(), 1u);
  EXPECT_EQ(publishers["other"].size(), 1u);
  EXPECT_EQ(publishers["one"], publishers["end"]);
  EXPECT_NE(publishers["one"], publishers["other"]);
}

TEST_F(TopicTest, TellsWhenMessagesWerePublishedAndWhetherOthersWereLost)
{
  const auto begin = std::chrono::system_clock::now();
  std::mutex mutex;
  std::vector<rcl_cxx::MessageInfo> received;
  const auto subscription = node->create_subscription<String>(
      "topic", rcl_cxx::QoS::reliable(10), [&](const String &, const rcl_cxx::MessageInfo & info) {
        const std::lock_guard lock(mutex);
        received.push_back(info);
      });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  publisher->publish(text("one"));
  publisher->publish(text("two"));
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return received.size() == 2;
  }));
  EXPECT_GE(received[0].published, begin);
  EXPECT_GE(received[1].published, received[0].published);
  EXPECT_LE(received[1].published, std::chrono::system_clock::now());
  if (!received[0].number) {
    GTEST_SKIP() << "this middleware does not count messages";
  }
  EXPECT_EQ(*received[1].number, *received[0].number + 1);
}

TEST_F(TopicTest, ReportsFailureAndContinues)
{
  std::promise<std::string> heard;
  const auto subscription = node->create_subscription<String>(
      "topic", rcl_cxx::QoS::reliable(10), [&](const String & message) { heard.set_value(message.data); });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  testing::internal::CaptureStderr();
  {
    const FailingPublish failing;
    EXPECT_FALSE(publisher->publish(text("lost")));
    EXPECT_FALSE(publisher->publish(text("lost, too")));
  }
  const std::string log = testing::internal::GetCapturedStderr();
  const std::string report = "publisher topic: message not published (rcl error 1: the network is down";
  EXPECT_THAT(log, HasSubstr(report));
  EXPECT_EQ(log.find(report), log.rfind(report)) << log;
  EXPECT_TRUE(publisher->publish(text("arrives")));
  auto future = heard.get_future();
  ASSERT_EQ(future.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(future.get(), "arrives");
}

TEST_F(TopicTest, ReportsMessageThatCannotBeSerialized)
{
  if (rcl_cxx::detail::compat::truncates_at_null_character) {
    GTEST_SKIP() << "this middleware sends the text before the null character";
  }
  const auto subscription =
      node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(10), [](const String &) {});
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  testing::internal::CaptureStderr();
  EXPECT_FALSE(publisher->publish(text(std::string("a\0b", 3))));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("null character"));
  EXPECT_TRUE(publisher->publish(text("good")));
}

TEST_F(TopicTest, TakesMessagesFromManyThreads)
{
  std::atomic<int> heard{0};
  const auto subscription = node->create_subscription<String>("topic", rcl_cxx::QoS::reliable(1000),
                                                              [&](const String &) { ++heard; });
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(1000));
  ASSERT_TRUE(eventually([&] { return publisher->get_subscription_count() == 1; }));
  std::vector<std::thread> talkers;
  for (int t = 0; t < 4; ++t) {
    talkers.emplace_back([&] {
      for (int i = 0; i < 100; ++i) {
        publisher->publish(text("x"));
      }
    });
  }
  for (std::thread & talker : talkers) {
    talker.join();
  }
  EXPECT_TRUE(eventually([&] { return heard == 400; })) << heard;
}

TEST_F(TopicTest, RejectsInvalidName)
{
  EXPECT_THROW(node->create_publisher<String>("not valid", rcl_cxx::QoS::reliable(1)), rcl_cxx::Error);
  try {
    node->create_subscription<String>("1st", rcl_cxx::QoS::reliable(1), [](const String &) {});
    FAIL() << "no exception";
  } catch (const rcl_cxx::Error & error) {
    EXPECT_THAT(error.what(), HasSubstr("subscription 1st"));
  }
}

TEST_F(TopicTest, IsSilentAfterShutdown)
{
  const auto publisher = node->create_publisher<String>("topic", rcl_cxx::QoS::reliable(10));
  context->shutdown("test");
  EXPECT_FALSE(publisher->publish(text("nobody")));
  EXPECT_EQ(publisher->get_subscription_count(), 0U);
}

TEST_F(ServiceTest, Responds)
{
  const auto service =
      node->create_service<SetBool>("set", [](const SetBool::Request & request, auto & response) {
        response.success = request.data;
        response.message = "done";
      });
  EXPECT_EQ(service->get_service_name(), "/test/set");
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  SetBool::Request request;
  request.data = true;
  const auto response = client->call(request, kLimit);
  ASSERT_TRUE(response) << response.error();
  EXPECT_TRUE(response->success);
  EXPECT_EQ(response->message, "done");
  EXPECT_EQ(client->pending_count(), 0U);
}

TEST_F(ServiceTest, RespondsToManyRequests)
{
  // With the default depth of 10, the middleware may drop requests.
  const rcl_cxx::QoS deep = rcl_cxx::QoS::services_default().keep_last(100);
  const auto service = node->create_service<SetBool>(
      "set", [](const SetBool::Request & request, auto & response) { response.success = request.data; },
      deep);
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set", deep);
  ASSERT_TRUE(client->wait_for_service(kLimit));
  std::vector<std::future<SetBool::Response>> answers;
  SetBool::Request request;
  for (int i = 0; i < 20; ++i) {
    request.data = i % 2 == 0;
    answers.push_back(client->async_send_request(request));
  }
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(answers[static_cast<std::size_t>(i)].wait_for(kLimit), std::future_status::ready);
    EXPECT_EQ(answers[static_cast<std::size_t>(i)].get().success, i % 2 == 0);
  }
}

TEST_F(ServiceTest, RespondsWhenCallbackThrows)
{
  const auto service = node->create_service<SetBool>("set", [](const SetBool::Request &, auto & response) {
    response.message = "half";
    throw std::runtime_error("is logged");
  });
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  const auto response = client->call(SetBool::Request(), kLimit);
  ASSERT_TRUE(response) << response.error();
  EXPECT_EQ(response->message, "half");
}

TEST_F(ServiceTest, SendsEmptyResponseInsteadOfOneThatCannotBeSerialized)
{
  if (rcl_cxx::detail::compat::truncates_at_null_character) {
    GTEST_SKIP() << "this middleware sends the text before the null character";
  }
  const auto service = node->create_service<SetBool>(
      "set", [](const SetBool::Request &, auto & response) { response.message = std::string("a\0b", 3); });
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  const auto response = client->call(SetBool::Request(), kLimit);
  ASSERT_TRUE(response) << response.error();
  EXPECT_EQ(response->message, "");
}

TEST_F(ServiceTest, ReportsMissingServiceAndMissingResponse)
{
  const auto client = rcl_cxx::create_client<SetBool>(*node, "none");
  EXPECT_FALSE(client->service_is_ready());
  EXPECT_EQ(client->call(SetBool::Request(), std::chrono::milliseconds(20)).error(),
            "/test/none: there is no such service");

  rcl_cxx::Node mute(context, "mute", "/test");  // in no executor
  const auto service = mute.create_service<SetBool>("none", [](const SetBool::Request &, auto &) {});
  ASSERT_TRUE(client->wait_for_service(kLimit));
  EXPECT_EQ(client->call(SetBool::Request(), std::chrono::milliseconds(50)).error(),
            "/test/none: no response within the timeout");
  EXPECT_EQ(client->pending_count(), 0U);
}

TEST_F(ServiceTest, RejectsBlockingCallInCallback)
{
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  std::promise<std::string> error;
  executor->post([&] { error.set_value(client->call(SetBool::Request(), kLimit).error()); });
  auto future = error.get_future();
  ASSERT_EQ(future.wait_for(kLimit), std::future_status::ready);
  EXPECT_THAT(future.get(), HasSubstr("never returns"));
}

TEST_F(ServiceTest, EndsBlockingCallAtShutdown)
{
  rcl_cxx::Node mute(context, "mute", "/test");
  const auto service = mute.create_service<SetBool>("set", [](const SetBool::Request &, auto &) {});
  const auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  ASSERT_TRUE(client->wait_for_service(kLimit));
  auto call =
      std::async(std::launch::async, [&] { return client->call(SetBool::Request(), kLimit).error(); });
  ASSERT_TRUE(eventually([&] { return client->pending_count() == 1; }));
  context->shutdown("test");
  EXPECT_THAT(call.get(), HasSubstr("shutting down"));
}

TEST_F(ServiceTest, BreaksPromisesOfDestroyedClient)
{
  rcl_cxx::Node mute(context, "mute", "/test");
  const auto service = mute.create_service<SetBool>("set", [](const SetBool::Request &, auto &) {});
  auto client = rcl_cxx::create_client<SetBool>(*node, "set");
  ASSERT_TRUE(client->wait_for_service(kLimit));
  auto answer = client->async_send_request(SetBool::Request());
  client.reset();
  EXPECT_THROW(answer.get(), std::future_error);
}
