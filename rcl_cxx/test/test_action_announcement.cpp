#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <thread>

#include "action_fixture.hpp"
#include "rcl_support/rcl_compat.hpp"

using testing::ElementsAre;

namespace {
/// Actions whose server is created for the first client.
class ActionAnnouncementTest : public Actions {
 protected:
  ActionAnnouncementTest() { creating_.add_callback_group(*group_); }
  ~ActionAnnouncementTest() override
  {
    context->shutdown("end of the test");
    thread_.join();
  }

  rcl_cxx::ActionServerOptions on_demand() const
  {
    rcl_cxx::ActionServerOptions options;
    options.creation_callback_group = group_;
    return options;
  }
  rcl_cxx::ActionServer::SharedPtr announce(const std::string & name)
  {
    rcl_cxx::TypedCallbacks<Fibonacci> handlers;
    handlers.handle_accepted = [](const std::shared_ptr<Handle> & handle) { handle->succeed(); };
    return rcl_cxx::create_action_server<Fibonacci>(*node, name, std::move(handlers), on_demand());
  }

 private:
  const rcl_cxx::CallbackGroup::SharedPtr group_ = node->create_callback_group();
  rcl_cxx::Executor creating_{context};
  std::thread thread_{[this] { creating_.spin(); }};
};
}  // namespace

TEST_F(ActionAnnouncementTest, TheFirstClientFindsTheServer)
{
  serve(on_demand());
  const auto goal = send(5);
  ASSERT_TRUE(goal);
  accepted(0)->succeed(result_of({0, 1, 1}));
  EXPECT_THAT(result(goal).result.sequence, ElementsAre(0, 1, 1));
}

TEST_F(ActionAnnouncementTest, AClientThatWaitedFindsTheServer)
{
  const auto waiting = rcl_cxx::create_action_client<Fibonacci>(*node, "later");
  EXPECT_FALSE(waiting->wait_for_action_server(std::chrono::milliseconds(50)));
  const auto later = announce("later");
  ASSERT_TRUE(waiting->wait_for_action_server(kLimit));
  EXPECT_TRUE(waiting->send_goal(goal_of(1), kLimit));
}

TEST_F(ActionAnnouncementTest, AllClientsHaveTheSameServer)
{
  serve(on_demand());
  const auto goal = send(5);
  ASSERT_TRUE(goal);
  const auto other = rcl_cxx::create_action_client<Fibonacci>(*node, "fibonacci");
  ASSERT_TRUE(other->wait_for_action_server(kLimit));
  EXPECT_EQ(send_with_id(goal->get_goal_id()), false) << "another server would not know the goal";
}

TEST_F(ActionAnnouncementTest, NothingServesWithoutAnActionClient)
{
  if (!rcl_cxx::detail::compat::reports_subscriptions) {
    GTEST_SKIP() << "Humble does not report new subscriptions";
  }
  const auto announced = announce("announced");
  const auto goals =
      rcl_cxx::create_client<Fibonacci::Impl::SendGoalService>(*node, "announced/_action/send_goal");
  EXPECT_FALSE(goals->wait_for_service(std::chrono::milliseconds(200)));
  const auto waiting = rcl_cxx::create_action_client<Fibonacci>(*node, "announced");
  EXPECT_TRUE(goals->wait_for_service(kLimit));
}

TEST_F(ActionAnnouncementTest, MayEndWhileItsServerIsCreated)
{
  for (int i = 0; i < 40; ++i) {
    const std::string name = "brief_" + std::to_string(i % 2);
    auto brief = announce(name);
    const auto waiting = rcl_cxx::create_action_client<Fibonacci>(*node, name);
    if (i % 3 == 0) {
      std::this_thread::yield();
    }
    brief.reset();
  }
  serve(on_demand());
  EXPECT_TRUE(send(1)) << "the thread that creates servers has ended";
}

TEST_F(ActionAnnouncementTest, AHangingCallbackOfTheNodeDoesNotDelayTheServer)
{
  std::mutex hanging;
  std::unique_lock hangs(hanging);
  const auto blocked =
      node->create_wall_timer(std::chrono::milliseconds(1), [&] { const std::lock_guard wait(hanging); });
  serve(on_demand());
  hangs.unlock();
}

TEST_F(ActionAnnouncementTest, ANameThatIsNoneIsRejectedAtOnce)
{
  EXPECT_THROW(announce("not a name"), rcl_cxx::Error);
}
