#include "ur_ros_rtde/detail/goal_book.hpp"

#include <gtest/gtest.h>

#include <future>
#include <rcl_cxx/executor.hpp>

namespace ur_ros_rtde {
namespace {
using rcl_cxx::GoalId;
using std::chrono::seconds;

class Goals : public testing::Test {
 protected:
  rcl_cxx::Context::SharedPtr context_ = std::make_shared<rcl_cxx::Context>(
      std::vector<std::string>{"goal_book_test"}, rcl_cxx::ContextOptions{.handle_signals = false});
  rcl_cxx::Node node_{context_, "goal_book_test"};
  PluginHost host_{node_};
  GoalBook book_{host_, "/test"};
  Interrupt interrupt_;
};

TEST_F(Goals, that_are_refused_give_the_reason_with_its_code)
{
  const auto admitted = book_.admit(
      GoalId::random(), [](GoalBook::Ticket &) { return failure(ErrorCode::invalid_goal, "speed is 9"); });
  ASSERT_FALSE(admitted);
  EXPECT_EQ(admitted.error(), "speed is 9 (invalid_goal 1)");
}

TEST_F(Goals, whose_check_throws_are_refused_with_its_text)
{
  const auto admitted = book_.admit(GoalId::random(), [](GoalBook::Ticket &) -> Status {
    throw std::runtime_error("a fault in the check");
  });
  ASSERT_FALSE(admitted);
  EXPECT_NE(admitted.error().find("a fault in the check"), std::string::npos);
}

TEST_F(Goals, that_throw_end_with_the_text)
{
  const Outcome outcome =
      book_.guarded(interrupt_, []() -> Outcome { throw std::out_of_range("vector::_M_range_check"); });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
  EXPECT_NE(outcome.message().find("vector::_M_range_check"), std::string::npos);
}

TEST_F(Goals, that_throw_an_error_of_the_robot_end_with_it)
{
  const Outcome outcome = book_.guarded(
      interrupt_, []() -> Outcome { throw RobotError(Error{ErrorCode::link_lost, "the link is lost"}); });
  EXPECT_EQ(outcome.code(), ErrorCode::link_lost);
  EXPECT_EQ(outcome.message(), "the link is lost");
}

TEST_F(Goals, that_throw_no_exception_of_the_library_end_too)
{
  const Outcome outcome = book_.guarded(interrupt_, []() -> Outcome { throw 42; });
  EXPECT_EQ(outcome.code(), ErrorCode::exception);
}

TEST_F(Goals, that_fail_after_they_were_asked_to_end_end_with_that_reason)
{
  interrupt_.request(Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(book_.guarded(interrupt_, [] { return Outcome::failure(ErrorCode::not_reached, "x"); }).code(),
            ErrorCode::canceled);
  EXPECT_TRUE(book_.guarded(interrupt_, [] { return Outcome::success(); }))
      << "it was faster than the cancel";
}

TEST_F(Goals, get_their_cancel)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(book_.admit(id, [](GoalBook::Ticket &) { return Status(); }));
  std::promise<ErrorCode> ended;
  ASSERT_TRUE(book_.start(id, [&ended](const std::shared_ptr<GoalBook::Ticket> & ticket) {
    const auto limit = std::chrono::steady_clock::now() + seconds(10);
    while (!ticket->interrupt->requested() && std::chrono::steady_clock::now() < limit) {
      std::this_thread::yield();
    }
    const auto why = ticket->interrupt->requested();
    ended.set_value(why ? why->code : ErrorCode::none);
  }));
  book_.end(id, Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(ended.get_future().get(), ErrorCode::canceled);
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

/// Goals that hold a resource from their admission on, as motions do.
class HoldingGoals : public Goals {
 protected:
  tl::expected<void, std::string> admit(const GoalId & id)
  {
    return book_.admit(id, [this](GoalBook::Ticket & ticket) -> Status {
      auto lease = arbiter_.acquire({Resource::motion, "/test", "1", {}});
      if (!lease) {
        return tl::unexpected(lease.error());
      }
      ticket.hold(std::move(*lease));
      return {};
    });
  }

  Arbiter arbiter_;
};

TEST_F(HoldingGoals, FreeWhatTheyHoldWhenTheyAreDiscarded)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  book_.discard(id);
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  EXPECT_FALSE(book_.start(id, [](const std::shared_ptr<GoalBook::Ticket> &) {}));
}

TEST_F(HoldingGoals, WaitForTheirAcceptanceWhileOthersAreAdmitted)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  EXPECT_FALSE(admit(GoalId::random())) << "the first one still holds the arm";
  EXPECT_TRUE(book_.start(id, [](const std::shared_ptr<GoalBook::Ticket> &) {}));
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, FreeWhatTheyHoldWhenTheyHaveToEndBeforeTheyStart)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  book_.end(id, Error{ErrorCode::preempted, "stop took over"});
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

TEST_F(HoldingGoals, KeepWhatTheyHoldWhileTheyComeToTheirEnd)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  ASSERT_TRUE(book_.start(id, [](const std::shared_ptr<GoalBook::Ticket> &) {}));
  book_.end(id, client_lost());
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  book_.finish(id, client_lost());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, AreNotReplacedByAnotherGoalOfTheSameId)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  std::promise<std::shared_ptr<GoalBook::Ticket>> started;
  ASSERT_TRUE(
      book_.start(id, [&](const std::shared_ptr<GoalBook::Ticket> & ticket) { started.set_value(ticket); }));
  const auto ticket = started.get_future().get();

  const auto again = book_.admit(id, [](GoalBook::Ticket &) { return Status(); });
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().find(id.to_string()), std::string::npos) << again.error();

  book_.end(id, Error{ErrorCode::canceled, "canceled by a client"});
  ASSERT_TRUE(ticket->interrupt->requested()) << "the cancel has to reach the goal that runs";
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(HoldingGoals, FreeWhatTheyHoldBeforeTheResultIsSent)
{
  const GoalId id = GoalId::random();
  ASSERT_TRUE(admit(id));
  EXPECT_TRUE(arbiter_.holder(Resource::motion));
  book_.finish(id, Outcome::success());
  EXPECT_FALSE(arbiter_.holder(Resource::motion));
}

}  // namespace
}  // namespace ur_ros_rtde
