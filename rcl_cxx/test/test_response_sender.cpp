#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <vector>

#include "node/node_impl.hpp"
#include "ros_fixture.hpp"
#include "services/response_sender.hpp"
#include "services/service_clients.hpp"

using rcl_cxx::detail::ClientDiscovery;
using rcl_cxx::detail::discovery_of;
using rcl_cxx::detail::Gid;
using rcl_cxx::detail::ResponseSender;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {
constexpr Gid kReader{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 1, 4};
constexpr Gid kWriterOfSameProcess{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 1, 3};
constexpr Gid kReaderOfOther{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 0, 0, 1, 4};

TEST(ClientDiscoveryTest, FindsClientWhoseReaderIsKnown)
{
  EXPECT_EQ(discovery_of(kReader, true, {{kReaderOfOther, kReader}}), ClientDiscovery::found);
}

TEST(ClientDiscoveryTest, WaitsForReaderOfProcessThatIsKnown)
{
  EXPECT_EQ(discovery_of(kReader, true, {{kReaderOfOther, kWriterOfSameProcess}}), ClientDiscovery::pending);
}

TEST(ClientDiscoveryTest, ClientWithoutKnownEndpointsIsGone)
{
  EXPECT_EQ(discovery_of(kReader, true, {{kReaderOfOther}}), ClientDiscovery::gone);
}

TEST(ClientDiscoveryTest, UnidentifiedClientIsGoneWithTheLastClient)
{
  EXPECT_EQ(discovery_of(kReader, false, {{kReaderOfOther}}), ClientDiscovery::found);
  EXPECT_EQ(discovery_of(kReader, false, {{}, 1}), ClientDiscovery::found);
  EXPECT_EQ(discovery_of(kReader, false, {{}, 0}), ClientDiscovery::gone);
}

class ResponseSenderTest : public InThread {
 protected:
  /// A response that the middleware cannot send before its attempt number `successful_attempt`.
  ResponseSender::Response response(int successful_attempt = 1)
  {
    return {
        [this, successful_attempt] { return ++attempts < successful_attempt ? RCL_RET_TIMEOUT : RCL_RET_OK; },
        {},
        [this] {
          ++checks;
          return client;
        },
        [this](rcl_ret_t code) { done.push_back(code); }};
  }

  std::shared_ptr<ResponseSender> sender =
      std::make_shared<ResponseSender>(node.impl(), node.impl()->default_group());
  ClientDiscovery client = ClientDiscovery::found;
  int attempts = 0;
  int checks = 0;
  std::vector<rcl_ret_t> done;
};

TEST_F(ResponseSenderTest, SendsAtOnceWhenClientIsDiscovered)
{
  sender->send(response());
  EXPECT_EQ(attempts, 1);
  EXPECT_EQ(checks, 0) << "the graph is not queried for clients that are discovered";
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(ResponseSenderTest, SendsWhenReaderOfClientIsDiscovered)
{
  client = ClientDiscovery::pending;
  sender->send(response(2));
  EXPECT_TRUE(executor.spin_until([&] { return checks > 5; }, kLimit));
  EXPECT_EQ(attempts, 1) << "an attempt blocks the executor";
  EXPECT_THAT(done, IsEmpty());
  client = ClientDiscovery::found;
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, kLimit));
  EXPECT_EQ(attempts, 2);
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(ResponseSenderTest, NeverGivesUpWhileClientExists)
{
  constexpr std::chrono::seconds earlier_limit{5};
  client = ClientDiscovery::pending;
  sender->send(response(2));
  EXPECT_FALSE(executor.spin_until([&] { return !done.empty(); }, earlier_limit + std::chrono::seconds(1)));
  client = ClientDiscovery::found;
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, kLimit));
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(ResponseSenderTest, GivesUpWhenClientIsGone)
{
  sender->send(response(1000));
  client = ClientDiscovery::gone;
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, kLimit));
  EXPECT_EQ(attempts, 1);
  EXPECT_THAT(done, ElementsAre(RCL_RET_TIMEOUT));
}

TEST_F(ResponseSenderTest, PausesBetweenAttemptsThatFail)
{
  sender->send(response(1000));
  const auto begin = ResponseSender::Clock::now();
  EXPECT_TRUE(executor.spin_until([&] { return attempts == 5; }, kLimit));
  EXPECT_GE(ResponseSender::Clock::now() - begin, std::chrono::milliseconds(20 + 40 + 80 + 160));
}

TEST_F(ResponseSenderTest, ClientThatIsNotDiscoveredDoesNotDelayOthers)
{
  client = ClientDiscovery::pending;
  sender->send(response(1000));
  ResponseSender::Response other = response(3);
  other.client = [] { return ClientDiscovery::found; };
  sender->send(std::move(other));
  EXPECT_TRUE(executor.spin_until([&] { return !done.empty(); }, kLimit));
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(ResponseSenderTest, SendsReplacementOfResponseThatCannotBeSerialized)
{
  ResponseSender::Response replaced = response();
  replaced.send_replacement = std::exchange(replaced.send, []() -> rcl_ret_t { throw 42; });
  sender->send(std::move(replaced));
  EXPECT_EQ(attempts, 1);
  EXPECT_THAT(done, ElementsAre(RCL_RET_OK));
}

TEST_F(ResponseSenderTest, SendsNothingAfterStop)
{
  sender->send(response(1000));
  sender->stop();
  EXPECT_FALSE(executor.spin_until([&] { return attempts > 1; }, std::chrono::milliseconds(200)));
  EXPECT_THAT(done, IsEmpty());
}

TEST_F(ResponseSenderTest, SendsNothingAfterStopInItsOwnCallback)
{
  ResponseSender::Response last = response(1000);
  last.client = [] { return ClientDiscovery::gone; };
  last.done = [this](rcl_ret_t) { sender->stop(); };
  sender->send(std::move(last));
  sender->send(response(1000));
  EXPECT_FALSE(executor.spin_until([&] { return !done.empty(); }, std::chrono::milliseconds(200)));
  EXPECT_EQ(attempts, 2) << "the first attempt of both";
}
}  // namespace
