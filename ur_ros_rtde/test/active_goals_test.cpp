#include "ur_ros_rtde/detail/active_goals.hpp"

#include <gtest/gtest.h>

#include <future>
#include <rcl_cxx/executor.hpp>

namespace ur_ros_rtde {
namespace {
using rcl_cxx::GoalUUID;
using std::chrono::seconds;

class Goals : public testing::Test {
 protected:
  rcl_cxx::Context::SharedPtr context_ = std::make_shared<rcl_cxx::Context>(
      std::vector<std::string>{"active_goals_test"}, rcl_cxx::InitOptions{.shutdown_on_signal = false});
  rcl_cxx::Node node_{context_, "active_goals_test"};
  PluginHost host_{node_};
  ActiveGoals active_goals_{host_, "/test"};
  StopRequest stop_request_;
};

TEST_F(Goals, that_are_refused_give_the_reason_with_its_code)
{
  const auto accepted = active_goals_.accept(
      GoalUUID::random(), [](GoalContext &) { return failure(ErrorCode::invalid_goal, "speed is 9"); });
  ASSERT_FALSE(accepted);
  EXPECT_EQ(accepted.error(), "speed is 9 (invalid_goal 1)");
}

TEST_F(Goals, whose_check_throws_are_refused_with_its_text)
{
  const auto accepted = active_goals_.accept(
      GoalUUID::random(), [](GoalContext &) -> Status { throw std::runtime_error("a fault in the check"); });
  ASSERT_FALSE(accepted);
  EXPECT_NE(accepted.error().find("a fault in the check"), std::string::npos);
}

TEST_F(Goals, that_throw_end_with_the_text)
{
  const Outcome outcome = active_goals_.guarded(
      stop_request_, []() -> Outcome { throw std::out_of_range("vector::_M_range_check"); });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
  EXPECT_NE(outcome.message().find("vector::_M_range_check"), std::string::npos);
}

TEST_F(Goals, that_throw_an_error_of_the_robot_end_with_it)
{
  const Outcome outcome = active_goals_.guarded(
      stop_request_, []() -> Outcome { throw RobotError(Error{ErrorCode::link_lost, "the link is lost"}); });
  EXPECT_EQ(outcome.code(), ErrorCode::link_lost);
  EXPECT_EQ(outcome.message(), "the link is lost");
}

TEST_F(Goals, that_throw_no_exception_of_the_library_end_too)
{
  const Outcome outcome = active_goals_.guarded(stop_request_, []() -> Outcome { throw 42; });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
}

TEST_F(Goals, that_fail_after_they_were_asked_to_end_end_with_that_reason)
{
  stop_request_.request(Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(active_goals_.guarded(stop_request_, [] { return Outcome::failure(ErrorCode::not_reached, "x"); })
                .code(),
            ErrorCode::canceled);
  EXPECT_TRUE(active_goals_.guarded(stop_request_, [] { return Outcome::success(); }))
      << "it was faster than the cancel";
}

TEST_F(Goals, get_their_cancel)
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
  active_goals_.end(id, Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(ended.get_future().get(), ErrorCode::canceled);
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

/// Goals that hold a resource from their admission on, as motions do.
class HoldingGoals : public Goals {
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

TEST_F(HoldingGoals, FreeWhatTheyHoldWhenTheyAreDiscarded)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.discard(id);
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  EXPECT_FALSE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
}

TEST_F(HoldingGoals, WaitForTheirAcceptanceWhileOthersAreAdmitted)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_FALSE(accept(GoalUUID::random())) << "the first one still holds the arm";
  EXPECT_TRUE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, FreeWhatTheyHoldWhenTheyHaveToEndBeforeTheyStart)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  active_goals_.end(id, Error{ErrorCode::preempted, "preempted by stop"});
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

TEST_F(HoldingGoals, KeepWhatTheyHoldWhileTheyComeToTheirEnd)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  ASSERT_TRUE(active_goals_.start(id, [](const std::shared_ptr<GoalContext> &) {}));
  active_goals_.end(id, client_lost());
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.finish(id, client_lost());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, AreNotReplacedByAnotherGoalOfTheSameId)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  std::promise<std::shared_ptr<GoalContext>> started;
  ASSERT_TRUE(active_goals_.start(
      id, [&](const std::shared_ptr<GoalContext> & context) { started.set_value(context); }));
  const auto context = started.get_future().get();

  const auto again = active_goals_.accept(id, [](GoalContext &) { return Status(); });
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().find(id.to_string()), std::string::npos) << again.error();

  active_goals_.end(id, Error{ErrorCode::canceled, "canceled by a client"});
  ASSERT_TRUE(context->stop_request->reason()) << "the cancel has to reach the goal that runs";
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, FreeWhatTheyHoldBeforeTheResultIsSent)
{
  const GoalUUID id = GoalUUID::random();
  ASSERT_TRUE(accept(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  active_goals_.finish(id, Outcome::success());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

}  // namespace
}  // namespace ur_ros_rtde
