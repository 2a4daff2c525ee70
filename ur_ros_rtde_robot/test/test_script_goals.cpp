// Scripts, and the goals before and after them.
#include <thread>

#include "script_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using ScriptGoalTest = ScriptTest;

/// Nothing tells yet that the control program is gone: its heartbeat may be missing for 50 ms.
TEST_F(ScriptGoalTest, IsNotSentAfterAProgramThatHasReplacedTheControlProgram)
{
  make_both();
  controller.control({{"command", "run_script"}, {"script", "def other():\n  sleep(0.3)\nend\n"}});
  const auto report = run_script(turning());
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(becomes_ready_again());
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptGoalTest, IsNotSentAfterAProgramThatBeganInItsPlace)
{
  make_both();
  ScriptOptions options;
  options.stop_reason = [&, started = false]() mutable -> std::optional<Error> {
    if (!std::exchange(started, true)) {
      controller.run_other_program();
      EXPECT_TRUE(eventually([&] { return plays(); }));
    }
    return std::nullopt;
  };
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_NE(report.error.message.find("another program, `other`"), std::string::npos) << report.error.message;
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(plays()) << log.text();
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready_again());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptGoalTest, IsNotSentForAGoalThatHasToEnd)
{
  make_both();
  for (const bool is_secondary : {false, true}) {
    ScriptOptions options = is_secondary ? secondary() : ScriptOptions();
    options.stop_reason = [] { return std::optional(Error{ErrorCode::canceled, "canceled"}); };
    const std::string output = "  set_standard_digital_out(2, True)\nend\n";
    const auto report = run_script((is_secondary ? "sec s():\n" : "def s():\n") + output, options);
    EXPECT_EQ(report.end, ScriptEnd::rejected) << report.error.message;
    EXPECT_EQ(report.error.code, ErrorCode::canceled) << report.error.message;
  }
  EXPECT_TRUE(is_back());
  EXPECT_EQ(robot->latest()->digital_outputs & 4U, 0U);
}

TEST_F(ScriptGoalTest, DoesNotEndAGoalThatWaitsForTheArmSinceBeforeItsBegin)
{
  make_both();
  const Generation received = stop_before_begin([] {});
  ASSERT_TRUE(becomes_ready());
  const Status continued = robot->is_continued(received);
  EXPECT_TRUE(continued) << continued.error().message;
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(eventually([&] { return !robot->is_continued(received); })) << "an operator has stopped it";
}

TEST_F(ScriptGoalTest, DoesNotEndAGoalThatComesWhileTheControlProgramReturns)
{
  make_both();
  std::vector<Generation> received;
  std::jthread client;
  stop_before_begin([&] {
    client = std::jthread([&](const std::stop_token & end) {
      while (!end.stop_requested()) {
        received.push_back(robot->generation());
        std::this_thread::sleep_for(1ms);
      }
    });
  });
  EXPECT_TRUE(eventually([&] { return robot->generation().restarted_by_driver == 1; }));
  client.request_stop();
  client.join();
  ASSERT_TRUE(becomes_ready());
  for (const Generation & generation : received) {
    const Status continued = robot->is_continued(generation);
    ASSERT_TRUE(continued) << continued.error().message;
  }
}

TEST_F(ScriptGoalTest, EndsAGoalThatWaitsForTheArmIfTheControlProgramDoesNotReturnAtOnce)
{
  make_both();
  const Generation received = stop_before_begin([&] {  // it begins, but does not answer
    controller.control(
        {{"command", "lose_commands"}, {"which", "rtde"}, {"clients", "control"}, {"count", 100000}});
  });
  ASSERT_TRUE(becomes_ready());
  EXPECT_FALSE(robot->is_continued(received)) << "an operator may have stopped it";
}

TEST_F(ScriptGoalTest, IsNotSentAsSecondaryProgramAfterACancelThatTheThreadHasNotSeen)
{
  make_both();
  std::stop_source cancel;
  ScriptOptions options = secondary();
  options.stop = cancel.get_token();
  options.stop_reason = [&]() -> std::optional<Error> {
    if (cancel.request_stop()) {  // right after the last look
      return std::nullopt;
    }
    return Error{ErrorCode::canceled, "canceled"};
  };
  const auto report = run_script("sec s():\n  set_standard_digital_out(2, True)\nend\n", options);
  EXPECT_EQ(report.end, ScriptEnd::rejected) << report.error.message;
  EXPECT_EQ(report.error.code, ErrorCode::canceled) << report.error.message;
  EXPECT_TRUE(is_back());
  EXPECT_EQ(robot->latest()->digital_outputs & 4U, 0U);
}

}  // namespace
}  // namespace ur_ros_rtde::test
