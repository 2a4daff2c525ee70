#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>

#include "action/client_watch.hpp"
#include "action_fixture.hpp"
#include "services/service_clients.hpp"

using rcl_cxx::detail::ClientWatch;
using rcl_cxx::detail::Gid;
using rcl_cxx::detail::ServiceClients;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

namespace {
constexpr Gid kClient{1};
constexpr Gid kInItsProcess{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7};
constexpr Gid kOther{2};
constexpr Gid kThird{3};
const ServiceClients kNobody{};

/// The clients are watched from time zero.
class ClientWatchTest : public testing::Test {
 protected:
  static ClientWatch::Clock::time_point at(double fraction_of_limit)
  {
    return ClientWatch::Clock::time_point() + std::chrono::duration_cast<ClientWatch::Clock::duration>(
                                                  fraction_of_limit * ClientWatch::kDiscoveryLimit);
  }

  ClientWatch exact{kClient, true, at(0.0)};
  ClientWatch opaque{kClient, false, at(0.0)};
};

TEST_F(ClientWatchTest, LosesDiscoveredClientAtOnce)
{
  EXPECT_FALSE(exact.is_lost({{kOther, kClient}}, at(0.1)));
  EXPECT_TRUE(exact.is_lost({{kOther}}, at(0.2)));
}

TEST_F(ClientWatchTest, KeepsDiscoveredClientForever)
{
  EXPECT_FALSE(exact.is_lost({{kClient}}, at(0.5)));
  EXPECT_FALSE(exact.is_lost({{kClient}}, at(1000.0)));
}

TEST_F(ClientWatchTest, WaitsForDiscoveryAndNoLonger)
{
  EXPECT_FALSE(exact.is_lost({{kInItsProcess}}, at(0.0)));
  EXPECT_FALSE(exact.is_lost({{kInItsProcess}}, at(0.9)));
  EXPECT_TRUE(exact.is_lost({{kInItsProcess}}, at(1.1)))
      << "another client is not the one that sent the goal";
}

TEST_F(ClientWatchTest, LosesClientAtOnceOfWhoseProcessNothingIsKnown)
{
  EXPECT_TRUE(exact.is_lost({{kOther}}, at(0.0)));
  EXPECT_TRUE(exact.is_lost(kNobody, at(0.0)));
}

TEST_F(ClientWatchTest, KeepsClientThatIsDiscoveredLate)
{
  EXPECT_FALSE(exact.is_lost({{kInItsProcess}}, at(0.9)));
  EXPECT_FALSE(exact.is_lost({{kInItsProcess, kClient}}, at(1.1)));
}

TEST_F(ClientWatchTest, LosesUnidentifiedClientWithTheLastCandidate)
{
  EXPECT_FALSE(opaque.is_lost({{kOther}}, at(0.1)));
  EXPECT_FALSE(opaque.is_lost({{kOther, kThird}}, at(0.2)));
  EXPECT_FALSE(opaque.is_lost({{kThird}}, at(1.1)));
  EXPECT_TRUE(opaque.is_lost(kNobody, at(1.2)));
}

TEST_F(ClientWatchTest, DoesNotTakeLaterClientForUnidentifiedOne)
{
  EXPECT_FALSE(opaque.is_lost({{kOther}}, at(0.1)));
  EXPECT_FALSE(opaque.is_lost({{kOther, kThird}}, at(1.1)));
  EXPECT_TRUE(opaque.is_lost({{kThird}}, at(1.2)));
}

TEST_F(ClientWatchTest, CountsClientsWhereNoEndpointsAreListed)
{
  EXPECT_FALSE(opaque.is_lost({{}, 1}, at(0.1)));
  EXPECT_FALSE(opaque.is_lost({{}, 1}, at(1.1)));
  EXPECT_TRUE(opaque.is_lost(kNobody, at(1.2)));
}

/// A client with a context of its own, as in another process.
class OtherProcess {
 public:
  explicit OtherProcess(const std::string & action = "fibonacci")
  {
    executor_.add_node(node_);
    thread_ = std::thread([this] { executor_.spin(); });
    client = rcl_cxx::create_action_client<Fibonacci>(*node_, action);
    EXPECT_TRUE(client->wait_for_action_server(kLimit));
  }
  ~OtherProcess()
  {
    context_->shutdown("end of the process");
    thread_.join();
  }

  rcl_cxx::GoalUUID send_accepted_goal()
  {
    auto response = client->async_send_goal(goal_of(1));
    if (response.wait_for(kLimit) != std::future_status::ready) {
      ADD_FAILURE() << "no response to the goal";
      return {};
    }
    handles_.push_back(response.get());
    return handles_.back()->get_goal_id();
  }

 private:
  std::shared_ptr<rcl_cxx::Context> context_ = make_context();
  std::shared_ptr<rcl_cxx::Node> node_ = std::make_shared<rcl_cxx::Node>(context_, "client", "/test");
  rcl_cxx::Executor executor_{context_};
  std::thread thread_;

 public:
  std::shared_ptr<rcl_cxx::ActionClient<Fibonacci>> client;

 private:
  std::vector<std::shared_ptr<rcl_cxx::ClientGoalHandle<Fibonacci>>> handles_;
};

class ClientLostTest : public Actions {
 protected:
  std::vector<rcl_cxx::GoalUUID> lost()
  {
    const std::lock_guard lock(mutex);
    return without_client;
  }
  bool is_lost(const rcl_cxx::GoalUUID & id)
  {
    const auto ids = lost();
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  }
  /// Number of endpoints of clients that the node of the server has discovered.
  std::size_t endpoints_of_clients() const
  {
    const auto clients = rcl_cxx::detail::find_clients(
        *node->impl(), node->resolve_service_name("fibonacci/_action/send_goal"));
    return clients ? clients->endpoints.size() + clients->unlisted : 0;
  }
};

TEST_F(ClientLostTest, IsReportedWhenItsContextEnds)
{
  serve();
  const auto without_other = endpoints_of_clients();
  auto other = std::make_unique<OtherProcess>();
  const auto goal = other->send_accepted_goal();
  const auto handle = accepted(0);
  std::promise<void> served;  // set after the acceptance and the first check of the client
  executor->post([&] { served.set_value(); });
  get(served.get_future());
  other.reset();
  ASSERT_TRUE(eventually([&] { return endpoints_of_clients() == without_other; }));
  // Timers that are due run in the order of their creation: the one of the server has run before this one.
  std::atomic<bool> has_checked{false};
  const auto timer = node->create_wall_timer(std::chrono::milliseconds(200), [&] { has_checked = true; });
  ASSERT_TRUE(eventually([&] { return has_checked.load(); }));
  EXPECT_TRUE(is_lost(goal)) << "it had been discovered";
  EXPECT_TRUE(handle->is_active()) << "only the callback may finish the goal";
  EXPECT_TRUE(handle->abort());
}

TEST_F(ClientLostTest, IsReportedWhenActionClientIsDestroyedAndItsNodeLives)
{
  serve();
  OtherProcess other;
  const auto goal = other.send_accepted_goal();
  const auto handle = accepted(0);
  other.client.reset();
  EXPECT_TRUE(eventually([&] { return is_lost(goal); }));
}

TEST_F(ClientLostTest, IsReportedOnceForEachOfItsGoalsAndNotForThoseOfOthers)
{
  serve();
  OtherProcess living;
  auto other = std::make_unique<OtherProcess>();
  const auto kept = living.send_accepted_goal();
  const auto first = other->send_accepted_goal();
  const auto second = other->send_accepted_goal();
  other->send_accepted_goal();  // finished before its client ends
  ASSERT_TRUE(accepted(3)->succeed());
  // A client that has not been discovered by now counts as lost.
  std::this_thread::sleep_for(1.2 * ClientWatch::kDiscoveryLimit);
  EXPECT_THAT(lost(), IsEmpty());
  other.reset();
  EXPECT_TRUE(eventually([&] { return is_lost(first) && is_lost(second); }));
  const auto last = std::make_unique<OtherProcess>()->send_accepted_goal();
  EXPECT_TRUE(eventually([&] { return is_lost(last); })) << "the server still watches clients";
  EXPECT_THAT(lost(), UnorderedElementsAre(first, second, last));
  EXPECT_THAT(lost(), Not(Contains(kept)));
}

TEST_F(ClientLostTest, IsReportedAfterTheEndOfAGoalThatKeepsWatchingIt)
{
  rcl_cxx::ActionServerOptions options;
  options.result_timeout = std::chrono::milliseconds(100);
  serve(options);
  auto other = std::make_unique<OtherProcess>();
  const auto watched = other->send_accepted_goal();
  const auto released = other->send_accepted_goal();
  for (const std::size_t goal : {0U, 1U}) {
    accepted(goal)->keep_watching_client();
    ASSERT_TRUE(accepted(goal)->succeed());
  }
  {
    const std::lock_guard lock(mutex);
    handles.pop_back();
  }
  EXPECT_TRUE(eventually([&] {
    return get(client->async_cancel_goal(watched)).code == CancelCode::unknown_goal;
  })) << "the result expires";
  EXPECT_THAT(lost(), IsEmpty());
  other.reset();
  EXPECT_TRUE(eventually([&] { return is_lost(watched); }));
  EXPECT_FALSE(is_lost(released)) << "its handle does not exist anymore";
}

TEST_F(ClientLostTest, DoesNotLeaveGoalRunningThatItSentAsItEnded)
{
  serve();
  auto other = std::make_unique<OtherProcess>();
  std::promise<void> client_ended;
  std::promise<rcl_cxx::GoalUUID> asked;
  on_goal = [&](const rcl_cxx::GoalUUID & id, const Fibonacci::Goal &) -> tl::expected<void, std::string> {
    asked.set_value(id);
    client_ended.get_future().wait_for(kLimit);
    return {};
  };
  auto response = other->client->async_send_goal(goal_of(1));
  const auto goal = get(asked.get_future());
  other.reset();
  client_ended.set_value();
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return without_client == std::vector{goal} || discarded == std::vector{goal};
  }));
}

/// As a launch file remaps it, with a rule for each topic and service.
/// One rule for the action, or one for each of its services and topics.
class RemappedActionTest : public testing::TestWithParam<bool> {
 protected:
  static std::vector<std::string> rules()
  {
    std::vector<std::string> rules{"--ros-args"};
    if (GetParam()) {
      rules.insert(rules.end(), {"-r", "fibonacci:=count"});
      return rules;
    }
    for (const std::string name : {"send_goal", "cancel_goal", "get_result", "feedback", "status"}) {
      rules.insert(rules.end(), {"-r", "fibonacci/_action/" + name + ":=count/_action/" + name});
    }
    return rules;
  }
};

TEST_P(RemappedActionTest, DoesNotLoseItsClients)
{
  const auto context = make_context(rules());
  rcl_cxx::Node node(context, "node", "/test");
  rcl_cxx::Executor executor(context);
  executor.add_node(node);
  std::thread thread([&] { executor.spin(); });
  std::promise<std::shared_ptr<Handle>> accepted;
  std::atomic<bool> lost{false};
  rcl_cxx::TypedCallbacks<Fibonacci> handlers;
  handlers.handle_accepted = [&](std::shared_ptr<Handle> handle) { accepted.set_value(std::move(handle)); };
  handlers.on_client_lost = [&](Handle &) { lost = true; };
  auto server = rcl_cxx::create_action_server<Fibonacci>(node, "fibonacci", std::move(handlers));
  {
    OtherProcess other("count");
    other.send_accepted_goal();
    const auto handle = accepted.get_future().get();
    std::this_thread::sleep_for(1.5 * ClientWatch::kDiscoveryLimit);
    EXPECT_FALSE(lost);
    EXPECT_TRUE(handle->is_active());
    other.client.reset();
    EXPECT_TRUE(eventually([&] { return lost.load(); })) << "it is still watched";
  }
  server.reset();
  context->shutdown("end of the test");
  thread.join();
}

INSTANTIATE_TEST_SUITE_P(Both, RemappedActionTest, testing::Bool());

TEST_F(ClientLostTest, MayDestroyItsServerInTheHandler)
{
  serve();
  auto other = std::make_unique<OtherProcess>();
  rcl_cxx::TypedCallbacks<Fibonacci> handlers;
  std::promise<void> called;
  handlers.handle_accepted = [this](std::shared_ptr<Handle> handle) { handles.push_back(std::move(handle)); };
  handlers.on_client_lost = [&](Handle &) {
    server.reset();
    called.set_value();
  };
  server.reset();
  server = rcl_cxx::create_action_server<Fibonacci>(*node, "fibonacci", std::move(handlers));
  ASSERT_TRUE(other->client->wait_for_action_server(kLimit));
  other->send_accepted_goal();
  other.reset();
  EXPECT_EQ(called.get_future().wait_for(kLimit), std::future_status::ready);
}

TEST_F(ClientLostTest, LeavesOtherGoalsToBeWatchedWhenTheHandlerThrows)
{
  rcl_cxx::TypedCallbacks<Fibonacci> handlers;
  std::atomic<int> calls{0};
  handlers.handle_accepted = [this](std::shared_ptr<Handle> handle) { handles.push_back(std::move(handle)); };
  handlers.on_client_lost = [&](Handle &) {
    ++calls;
    throw std::runtime_error("is logged");
  };
  server = rcl_cxx::create_action_server<Fibonacci>(*node, "fibonacci", std::move(handlers));
  auto other = std::make_unique<OtherProcess>();
  other->send_accepted_goal();
  other->send_accepted_goal();
  other.reset();
  EXPECT_TRUE(eventually([&] { return calls == 2; }));
}
}  // namespace
