#include "ur_ros_rtde/goal_book.hpp"

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
  book_.cancel(id);
  EXPECT_EQ(ended.get_future().get(), ErrorCode::canceled);
  host_.goals().close(Error{ErrorCode::shutdown, ""}, seconds(10));
}

TEST_F(Goals, that_were_admitted_but_never_accepted_give_back_what_they_hold)
{
  Arbiter arbiter;
  const auto hold = [&arbiter](GoalBook::Ticket & ticket) -> Status {
    auto lease = arbiter.acquire({Resource::motion, "/test", "1", {}});
    if (!lease) {
      return tl::unexpected(lease.error());
    }
    ticket.lease = std::move(*lease);
    return {};
  };
  ASSERT_TRUE(book_.admit(GoalId::random(), hold));
  EXPECT_TRUE(book_.admit(GoalId::random(), hold)) << "the first one still holds the robot";
}

TEST_F(Goals, that_end_free_what_they_hold_before_the_result_is_sent)
{
  Arbiter arbiter;
  const GoalId id = GoalId::random();
  ASSERT_TRUE(book_.admit(id, [&arbiter](GoalBook::Ticket & ticket) {
    ticket.lease = std::move(*arbiter.acquire({Resource::motion, "/test", "1", {}}));
    return Status();
  }));
  EXPECT_TRUE(arbiter.holder(Resource::motion));
  book_.finish(id, Outcome::success());
  EXPECT_FALSE(arbiter.holder(Resource::motion));
}

}  // namespace
}  // namespace ur_ros_rtde
