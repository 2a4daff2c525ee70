#include <fmt/format.h>
#include <gtest/gtest.h>

#include <future>
#include <rcl_cxx/executor.hpp>

#include "ur_ros_rtde/detail/active_goals.hpp"
#include "ur_ros_rtde/detail/guarded.hpp"

namespace ur_ros_rtde {
namespace {
using rcl_cxx::GoalUUID;
using std::chrono::seconds;

class ActiveGoalsTest : public testing::Test {
 protected:
  rcl_cxx::Context::SharedPtr context_ = std::make_shared<rcl_cxx::Context>(
      std::vector<std::string>{"test_active_goals"}, rcl_cxx::InitOptions{.shutdown_on_signal = false});
  rcl_cxx::Node node_{context_, "test_active_goals"};
  PluginHost host_{node_};
  ActiveGoals active_goals_{host_, "/test"};
  StopRequest stop_request_;
};

TEST_F(ActiveGoalsTest, RefusalHasReasonAndCode)
{
  const auto accepted = active_goals_.accept(
      GoalUUID::random(), [](GoalContext &) { return failure(ErrorCode::invalid_goal, "speed is 9"); });
  ASSERT_FALSE(accepted);
  EXPECT_EQ(accepted.error(), "speed is 9 (invalid_goal 1)");
}

TEST_F(ActiveGoalsTest, CheckThatThrowsRefusesWithItsText)
{
  const auto accepted = active_goals_.accept(
      GoalUUID::random(), [](GoalContext &) -> Status { throw std::runtime_error("a fault in the check"); });
  ASSERT_FALSE(accepted);
  EXPECT_NE(accepted.error().find("a fault in the check"), std::string::npos);
}

TEST_F(ActiveGoalsTest, CheckThatThrowsARobotErrorRefusesWithItsCode)
{
  const auto accepted = active_goals_.accept(GoalUUID::random(), [](GoalContext &) -> Status {
    throw RobotError(Error{ErrorCode::busy, "a script is running"});
  });
  ASSERT_FALSE(accepted);
  EXPECT_EQ(accepted.error(),
            fmt::format("a script is running (busy {})", static_cast<int>(ErrorCode::busy)));
}

TEST_F(ActiveGoalsTest, CheckThatThrowsAnExceptionOfAnyTypeRefuses)
{
  EXPECT_FALSE(active_goals_.accept(GoalUUID::random(), [](GoalContext &) -> Status { throw 42; }));
}

TEST_F(ActiveGoalsTest, ExceptionBecomesTheOutcome)
{
  const Outcome outcome =
      guarded(stop_request_, []() -> Outcome { throw std::out_of_range("vector::_M_range_check"); });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
  EXPECT_NE(outcome.message().find("vector::_M_range_check"), std::string::npos);
}

TEST_F(ActiveGoalsTest, RobotErrorBecomesTheOutcome)
{
  const Outcome outcome = guarded(
      stop_request_, []() -> Outcome { throw RobotError(Error{ErrorCode::link_lost, "the link is lost"}); });
  EXPECT_EQ(outcome.code(), ErrorCode::link_lost);
  EXPECT_EQ(outcome.message(), "the link is lost");
}

TEST_F(ActiveGoalsTest, ExceptionOfAnyTypeBecomesTheOutcome)
{
  const Outcome outcome = guarded(stop_request_, []() -> Outcome { throw 42; });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
}

TEST_F(ActiveGoalsTest, FailureAfterAStopRequestHasItsReason)
{
  stop_request_.request(Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(guarded(stop_request_, [] { return Outcome::failure(ErrorCode::not_reached, "x"); }).code(),
            ErrorCode::canceled);
  EXPECT_TRUE(guarded(stop_request_, [] { return Outcome::success(); })) << "it was faster than the cancel";
}

TEST_F(ActiveGoalsTest, CancelReachesTheGoal)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(active_goals_.accept(id, [](GoalContext &) { return Status(); }));
  std::promise<ErrorCode> ended;
  ASSERT_TRUE(active_goals_.start(id, [&ended](const std::shared_ptr<GoalContext> & context) {
    const auto limit = std::chrono::steady_clock::now() + seconds(10);
    while (!context->stop_request->reason() && std::chrono::steady_clock::now() < limit) {
      std::this_thread::yield();
    }
    const auto why = context->stop_request->reason();
    ended.set_value(why ? why->code : ErrorCode::none);
  }));
  active_goals_.stop(id, Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(ended.get_future().get(), ErrorCode::canceled);
  host_.goal_threads().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

/// Goals that hold a resource from their acceptance, as motions do.
class GoalWithLeaseTest : public ActiveGoalsTest {
 protected:
  tl::expected<void, std::string> accept(const GoalUUID & id)
  {
    return active_goals_.accept(id, [this](GoalContext & context) -> Status {
      auto lease = arbiter_.acquire({Resource::motion, "/test", "1", {}});
      if (!lease) {
        return tl::unexpected(lease.error());
      }
      context.hold(std::move(*lease));
      return {};
    });
  }

  Arbiter arbiter_;
};

TEST_F(GoalWithLeaseTest, DiscardedGoalReleasesItsLease)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.discard(id);
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  EXPECT_FALSE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
}

TEST_F(GoalWithLeaseTest, KeepsItsLeaseWhileAnotherGoalIsRefused)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_FALSE(accept(GoalUUID::random())) << "the first one still holds the arm";
  EXPECT_TRUE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
  host_.goal_threads().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(GoalWithLeaseTest, GoalStoppedBeforeItsStartReleasesItsLease)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  active_goals_.stop(id, Error{ErrorCode::preempted, "preempted by stop"});
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

TEST_F(GoalWithLeaseTest, StoppedGoalKeepsItsLeaseUntilItsEnd)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  ASSERT_TRUE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
  active_goals_.stop(id, client_lost());
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.finish(id, client_lost());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  host_.goal_threads().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(GoalWithLeaseTest, LeaseIsReleasedBeforeTheResultIsSent)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.finish(id, Outcome::success());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

}  // namespace
}  // namespace ur_ros_rtde
