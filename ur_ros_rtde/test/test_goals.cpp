// The life of a goal: acceptance, execution, the request to stop it, and its only result.
#include "goal_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST_F(GoalTest, SucceedsWithItsMessage)
{
  behavior_.execute = [](const StopRequest &) { return Outcome::success("done"); };
  serve();
  const auto end = send();
  ASSERT_TRUE(end) << end.error();
  EXPECT_EQ(end->status, rcl_cxx::GoalStatus::succeeded);
  EXPECT_TRUE(end->result.success);
  EXPECT_EQ(end->result.message, "done");
}

TEST_F(GoalTest, IsRejectedWithTheReasonOfItsCheck)
{
  bool released = false;
  behavior_.check = [](std::vector<GoalQuery> &) { return failure(ErrorCode::invalid_goal, "speed is 9"); };
  behavior_.release = [&] { released = true; };
  serve();
  EXPECT_FALSE(send());
  EXPECT_FALSE(released) << "it is released by the check itself";
}

TEST_F(GoalTest, ACheckThatThrowsRejects)
{
  for (const std::function<void()> & fault : std::vector<std::function<void()>>{
           [] { throw std::runtime_error("a fault in the check"); }, [] { throw 42; },
           [] { throw RobotError(Error{ErrorCode::busy, "a script is running"}); }}) {
    behavior_.check = [&](std::vector<GoalQuery> &) {
      fault();
      return Status();
    };
    serve();
    EXPECT_FALSE(send());
    server_.reset();
  }
}

TEST_F(GoalTest, IsAcceptedAfterItsQueriesOrRejected)
{
  Status answer;
  std::thread::id asked_in;
  int released = 0;
  behavior_.check = [&](std::vector<GoalQuery> & queries) {
    queries.push_back([&] {
      asked_in = std::this_thread::get_id();
      return answer;
    });
    return Status();
  };
  behavior_.release = [&] { ++released; };
  serve();
  EXPECT_TRUE(send());
  EXPECT_EQ(released, 1) << "before the result";
  answer = failure(ErrorCode::unreachable, "too far");
  EXPECT_FALSE(send());
  EXPECT_EQ(released, 2);
  EXPECT_NE(asked_in, std::thread::id());
}

TEST_F(GoalTest, AnExceptionIsItsOutcome)
{
  behavior_.execute = [](const StopRequest &) -> Outcome {
    throw std::out_of_range("vector::_M_range_check");
  };
  serve();
  const auto end = send();
  ASSERT_TRUE(end) << end.error();
  EXPECT_EQ(end->status, rcl_cxx::GoalStatus::aborted);
  EXPECT_EQ(end->result.error_code, static_cast<std::uint16_t>(ErrorCode::exception));
  EXPECT_NE(end->result.message.find("vector::_M_range_check"), std::string::npos);
}

TEST_F(GoalTest, AnExceptionInFillResultAbortsIt)
{
  behavior_.fill_result = [](const Outcome &, Trigger::Result &) {
    throw std::runtime_error("a fault in fill_result");
  };
  serve();
  const auto end = send();
  ASSERT_TRUE(end) << end.error();
  EXPECT_EQ(end->status, rcl_cxx::GoalStatus::aborted);
  EXPECT_EQ(end->result.error_code, static_cast<std::uint16_t>(ErrorCode::exception));
  EXPECT_NE(end->result.message.find("a fault in fill_result"), std::string::npos) << end->result.message;
}

TEST_F(GoalTest, IsCanceled)
{
  behavior_.execute = until_told;
  serve();
  const auto goal = send_and_go_on();
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->async_cancel().get().code, rcl_cxx::CancelCode::none);
  const auto end = result(goal);
  EXPECT_EQ(end.status, rcl_cxx::GoalStatus::canceled);
  EXPECT_EQ(end.result.error_code, static_cast<std::uint16_t>(ErrorCode::canceled));
}

/// With a command that never looks.
class HangingGoalTest : public GoalTest {
 protected:
  HangingGoalTest()
  {
    behavior_.execute = [this](const StopRequest &) {
      returns_.get_future().wait();
      return Outcome::success("too late");
    };
  }
  /// The future result of a goal that was canceled.
  auto cancel_a_goal()
  {
    serve();
    const auto goal = send_and_go_on();
    EXPECT_TRUE(goal);
    EXPECT_EQ(goal->async_cancel().get().code, rcl_cxx::CancelCode::none);
    return goal->async_get_result();
  }

  std::promise<void> returns_;
};

/// Its result does not stay away, and its thread does no harm.
TEST_F(HangingGoalTest, IsEndedIfItsCommandDoesNotReturn)
{
  std::atomic<bool> at_rest{false};
  std::atomic<int> released{0};
  behavior_.stopped = [&] { return at_rest ? std::make_optional(Status()) : std::nullopt; };
  behavior_.release = [&] { ++released; };
  auto end = cancel_a_goal();
  EXPECT_EQ(end.wait_for(Goals::return_timeout + milliseconds(200)), std::future_status::timeout)
      << "not before the arm is at rest";
  at_rest = true;
  ASSERT_EQ(end.wait_for(seconds(20)), std::future_status::ready);
  EXPECT_EQ(end.get().status, rcl_cxx::GoalStatus::canceled);
  EXPECT_NE(end.get().result.message.find("did not return"), std::string::npos) << end.get().result.message;
  EXPECT_EQ(released, 1);
  returns_.set_value();
}

TEST_F(HangingGoalTest, SaysIfTheArmDoesNotRest)
{
  behavior_.stopped = [] { return failure(ErrorCode::timeout, "all attempts have failed"); };
  auto end = cancel_a_goal();
  EXPECT_EQ(end.wait_for(seconds(20)), std::future_status::ready);
  returns_.set_value();
  const std::string message = end.get().result.message;
  EXPECT_NE(message.find("standstill is not confirmed: all attempts have failed"), std::string::npos)
      << message;
}

/// No client tells the goal to end, and its command does not look at the robot.
TEST_F(HangingGoalTest, IsEndedIfTheRobotHasStoppedAndItsCommandDoesNotLook)
{
  std::atomic<bool> stopped{false};
  behavior_.ended_by_robot = [&] {
    return stopped ? std::make_optional(Error{ErrorCode::protective_stop, "a protective stop"})
                   : std::nullopt;
  };
  serve();
  const auto goal = send_and_go_on();
  ASSERT_TRUE(goal);
  stopped = true;
  auto end = goal->async_get_result();
  EXPECT_EQ(end.wait_for(seconds(10)), std::future_status::ready);
  returns_.set_value();
  EXPECT_EQ(end.get().status, rcl_cxx::GoalStatus::aborted);
  EXPECT_EQ(end.get().result.error_code, static_cast<std::uint16_t>(ErrorCode::protective_stop));
}

TEST_F(GoalTest, AResultThatHangsDelaysNoOther)
{
  std::promise<void> returns;
  std::promise<void> writes;
  const auto returned = returns.get_future().share();
  const auto written = writes.get_future().share();
  behavior_.execute = [returned](const StopRequest &) {
    returned.wait();
    return Outcome::success("too late");
  };
  serve();
  std::atomic<int> results{0};
  std::promise<void> hangs;
  behavior_.fill_result = [&, written](const Outcome & outcome, Trigger::Result & result) {
    if (++results == 1) {
      hangs.set_value();
      written.wait();
    }
    write_standard_fields(outcome, result);
  };
  const auto first = send_and_go_on();
  const auto second = send_and_go_on();
  ASSERT_TRUE(first && second);
  first->async_cancel().get();
  EXPECT_EQ(hangs.get_future().wait_for(seconds(20)), std::future_status::ready);
  second->async_cancel().get();
  auto end = second->async_get_result();
  EXPECT_EQ(end.wait_for(seconds(20)), std::future_status::ready);
  writes.set_value();
  returns.set_value();
  EXPECT_EQ(result(first).status, rcl_cxx::GoalStatus::canceled);
}

TEST_F(GoalTest, WithoutAResultDoesNotAskItsCommandForOne)
{
  int asked = 0;
  behavior_.fill_result = [&](const Outcome & outcome, Trigger::Result & result) {
    ++asked;
    write_standard_fields(outcome, result);
  };
  const auto write = make_missing_results(behavior_);
  const int asked_before = asked;
  Trigger::Result unknown;
  write(rcl_cxx::GoalStatus::unknown, &unknown);
  Trigger::Result aborted;
  write(rcl_cxx::GoalStatus::aborted, &aborted);
  EXPECT_EQ(asked, asked_before) << "requests for results are served by the thread that serves stops";
  EXPECT_NE(unknown.message.find("no such goal"), std::string::npos) << unknown.message;
  EXPECT_NE(aborted.message.find("without a result"), std::string::npos) << aborted.message;
}

TEST_F(GoalTest, CancelDoesNotWaitForTheCheckOfAnotherGoal)
{
  behavior_.execute = until_told;
  serve();
  const auto goal = send_and_go_on();
  ASSERT_TRUE(goal);
  const std::shared_ptr<Goal> first = goal_;
  std::promise<void> checking;
  std::promise<void> ends;
  behavior_.check = [&](std::vector<GoalQuery> &) {
    checking.set_value();
    ends.get_future().wait();
    return Status();
  };
  auto second = client_->async_send_goal(Trigger::Goal());
  checking.get_future().wait();
  auto canceling = goal->async_cancel();
  const auto limit = std::chrono::steady_clock::now() + seconds(20);
  while (!first->is_finished() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::yield();
  }
  EXPECT_TRUE(first->is_finished()) << "while the check of the other goal still runs";
  ends.set_value();
  EXPECT_EQ(canceling.get().code, rcl_cxx::CancelCode::none);
  second.get()->async_cancel().get();
}

TEST_F(GoalTest, IsToldToEndAtTheShutdown)
{
  behavior_.execute = until_told;
  serve();
  const auto goal = send_and_go_on();
  ASSERT_TRUE(goal);
  EXPECT_TRUE(host_.goals().close(Error{ErrorCode::shutdown, "the end"}, seconds(10)).empty());
  EXPECT_EQ(result(goal).result.error_code, static_cast<std::uint16_t>(ErrorCode::shutdown));
  EXPECT_FALSE(send()) << "no goal is accepted anymore";
}

TEST_F(GoalTest, ShutdownNamesAGoalWhoseThreadDoesNotEnd)
{
  std::promise<void> returns;
  behavior_.execute = [&](const StopRequest &) {
    returns.get_future().wait();
    return Outcome::success();
  };
  serve();
  ASSERT_TRUE(send_and_go_on());
  const auto left = host_.goals().close(Error{ErrorCode::shutdown, "the end"}, milliseconds(10));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left.front().substr(0, 6), "/test ");
  returns.set_value();
}

TEST_F(GoalTest, IsRejectedAboveTheLimitUntilOneHasEnded)
{
  behavior_.execute = until_told;
  serve();
  std::vector<std::shared_ptr<rcl_cxx::ClientGoalHandle<Trigger>>> goals;
  for (std::size_t i = 0; i < Goals::limit; ++i) {
    goals.push_back(send_and_go_on());
    ASSERT_TRUE(goals.back()) << i;
  }
  EXPECT_FALSE(send());
  EXPECT_TRUE(stops()) << "a stop has threads of its own";
  goals.front()->async_cancel().get();
  result(goals.front());
  const auto limit = std::chrono::steady_clock::now() + seconds(20);
  while (!host_.goals().can_start() && std::chrono::steady_clock::now() < limit) {
    std::this_thread::yield();
  }
  EXPECT_TRUE(send_and_go_on());
}

class LostClientTest : public GoalTest {
 protected:
  /// The reason for the end of a goal whose client disappears, or none within 2 s.
  ErrorCode end_without_client(bool stops)
  {
    const auto ended = std::make_shared<std::promise<ErrorCode>>();
    behavior_.execute = [ended](const StopRequest & stop_request) {
      const Outcome outcome = until_told(stop_request);
      ended->set_value(outcome.code());
      return outcome;
    };
    if (stops) {
      serve([](const rcl_cxx::GoalUUID &) {});
    } else {
      serve();
    }
    {
      rcl_cxx::Node other{make_context("client"), "client"};
      const auto client = rcl_cxx::create_action_client<Trigger>(other, "test");
      const Spinning spins(other);
      EXPECT_TRUE(client->wait_for_action_server(seconds(20)));
      EXPECT_TRUE(client->async_send_goal(Trigger::Goal()).get());
    }
    auto end = ended->get_future();
    return end.wait_for(stops ? seconds(20) : seconds(2)) == std::future_status::ready ? end.get()
                                                                                       : ErrorCode::none;
  }
};

TEST_F(LostClientTest, StopsItsGoal)
{
  EXPECT_EQ(end_without_client(true), ErrorCode::client_lost);
}

TEST_F(LostClientTest, DoesNotStopItsGoalIfSoConfigured)
{
  EXPECT_EQ(end_without_client(false), ErrorCode::none);
}

TEST(GuardedTest, AFailureAfterAStopRequestHasItsReason)
{
  StopRequest stop_request;
  stop_request.request(Error{ErrorCode::canceled, "canceled by a client"});
  EXPECT_EQ(guarded(stop_request, [] { return Outcome::failure(ErrorCode::not_reached, "x"); }).code(),
            ErrorCode::canceled);
  EXPECT_TRUE(guarded(stop_request, [] { return Outcome::success(); })) << "it was faster than the cancel";
}

TEST(StopRequestTest, KeepsTheFirstReason)
{
  StopRequest stop_request;
  EXPECT_FALSE(stop_request.reason());
  EXPECT_TRUE(stop_request.request(Error{ErrorCode::canceled, "first"}));
  EXPECT_FALSE(stop_request.request(Error{ErrorCode::preempted, "second"}));
  ASSERT_TRUE(stop_request.reason());
  EXPECT_EQ(stop_request.reason()->message, "first");
  EXPECT_TRUE(stop_request.token().stop_requested());
}

}  // namespace
}  // namespace ur_ros_rtde::test
