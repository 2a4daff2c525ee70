#include "script_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST_F(ScriptTest, RunsToItsEndAndReportsItsText)
{
  make_both();
  const auto report = run_script(
      "def f():\n  textmsg(\"one\")\n  sync()\n  textmsg(\"two \", 2)\n  q = get_actual_joint_positions()\n"
      "  q[0] = q[0] + 0.1\n  movej(q, a=3, v=1)\nend\n");
  EXPECT_TRUE(report) << report.error.message;
  EXPECT_EQ(report.end, ScriptEnd::finished);
  EXPECT_EQ(report.text, (std::vector<std::string>{"one", "two 2"}));
  EXPECT_GT(report.duration, 0.1);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, FollowsScriptsOfAnyDuration)
{
  make_both();
  for (int i = 0; i < 3; ++i) {
    const auto report = run_script("textmsg(\"there\")");
    EXPECT_TRUE(report) << report.error.message;
    EXPECT_EQ(report.text, std::vector<std::string>{"there"});
  }
  EXPECT_TRUE(is_back());
}

/// The sample of the time between the control program and the script comes after the script has begun.
TEST_F(ScriptTest, IsNotStoppedByASampleThatIsOlderThanItsBegin)
{
  auto options_of_robot = robot_options();
  options_of_robot.watchdog_frequency = 0.0;
  make_both(options_of_robot);
  const auto delay = [&](const char * which, int ms) {
    controller.control({{"command", "delay_links"}, {"which", which}, {"ms", ms}});
  };
  ScriptOptions options;
  options.on_text = [&](const std::string & text) {
    if (text == "begins") {
      delay("rtde", 0);
    } else {
      delay("primary", 50);  // the end of the script is seen before its last text
    }
  };
  delay("rtde", 150);
  const auto report = run_script("textmsg(\"begins\")\nsleep(0.5)\ntextmsg(\"ends\")\nsleep(0.1)\n", options);
  delay("primary", 0);
  EXPECT_EQ(report.end, ScriptEnd::finished) << report.error.message;
}

TEST_F(ScriptTest, RestartsTheControlProgramAtOnce)
{
  make_both();
  std::vector<Clock::time_point> text;
  ScriptOptions options;
  options.on_text = [&](const std::string &) { text.push_back(Clock::now()); };
  ASSERT_TRUE(run_script("textmsg(\"done\")", options));
  ASSERT_EQ(text.size(), 1U);
  ASSERT_TRUE(robot->ready_to_move());
  const std::chrono::duration<double> back = Clock::now() - text.front();
  RecordProperty("back_after_s", std::to_string(back.count()));
  EXPECT_LT(back.count(), 3.0);
  const std::lock_guard lock(mutex);
  EXPECT_EQ(statuses.back().state, RobotState::ready);
  EXPECT_EQ(log.count("a program was running"), 0U) << log.text();
}

TEST_F(ScriptTest, ReportsTheLineOfACompileError)
{
  make_both();
  const auto report = run_script("def f():\n  sync()\n\n  sync(1, 2, 3) nonsense\nend\n");
  EXPECT_EQ(report.end, ScriptEnd::compile_error) << report.error.message;
  EXPECT_EQ(report.error.code, ErrorCode::rejected_by_robot);
  EXPECT_EQ(report.line, 4) << report.error.message;
  EXPECT_NE(report.error.message.find("line 4"), std::string::npos) << report.error.message;
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, ReportsTheLineOfARuntimeError)
{
  make_both();
  const auto report = run_script("def f():\n  textmsg(\"so far\")\n  a = [1, 2]\n  b = a[7]\nend\n");
  EXPECT_EQ(report.end, ScriptEnd::runtime_error) << report.error.message;
  EXPECT_EQ(report.line, 4) << report.error.message;
  EXPECT_EQ(report.text, std::vector<std::string>{"so far"});
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, RejectsUnbalancedBlocksWithoutSending)
{
  make_both();
  const auto report = run_script("def f():\n  while True:\n  sync()\nend\n");
  EXPECT_EQ(report.end, ScriptEnd::rejected);
  EXPECT_EQ(report.error.code, ErrorCode::invalid_goal);
  EXPECT_EQ(report.line, 1) << report.error.message;
  EXPECT_TRUE(robot->control_for_queries()->isProgramRunning()) << "the control program was not disturbed";
}

TEST_F(ScriptTest, KeepsTheControlInterfaceToItself)
{
  make_both();
  ScriptOptions options;
  std::optional<ErrorCode> found;
  options.on_text = [&](const std::string &) {
    EXPECT_TRUE(robot->ready_to_move()) << "a command that preempts the script can be accepted";
    EXPECT_EQ(run_script("sync()").error.code, ErrorCode::busy);
    try {
      robot->control_for_queries();
    } catch (const RobotError & error) {
      found = error.error().code;
    }
  };
  EXPECT_TRUE(run_script("textmsg(\"now\")\nsleep(0.1)", options));
  EXPECT_EQ(found, ErrorCode::busy);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsRejectedWhileTheRobotIsNotReady)
{
  make_both();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  const auto report = run_script("sync()");
  EXPECT_EQ(report.end, ScriptEnd::rejected);
  EXPECT_EQ(report.error.code, ErrorCode::protective_stop);
}

TEST_F(ScriptTest, LeavesTheRobotUsableWhenACallbackThrows)
{
  make_both();
  ScriptOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    if (turns()) {
      throw std::runtime_error("thrown");
    }
    return std::nullopt;
  };
  EXPECT_THROW(run_script(turning(), options), std::runtime_error);
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, RunsDuringAMotionAsSecondaryProgram)
{
  make_both();
  move_joints();
  const auto report = run_script("sec s():\n  set_standard_digital_out(2, True)\nend\n", secondary());
  EXPECT_TRUE(report) << report.error.message;
  EXPECT_TRUE(turns()) << "the motion continues";
  EXPECT_TRUE(eventually([&] { return (robot->latest()->digital_outputs & 4U) != 0; }));
  EXPECT_TRUE(robot->stop_motion());
}

TEST_F(ScriptTest, ReportsTheLinesOfErrorsInSecondaryPrograms)
{
  make_both();
  const auto wrong = run_script("sec s():\n  nonsense nonsense\nend\n", secondary());
  EXPECT_EQ(wrong.end, ScriptEnd::compile_error) << wrong.error.message;
  EXPECT_EQ(wrong.line, 2) << wrong.error.message;
  const auto failing = run_script("a = [1]\nb = a[3]\n", secondary());
  EXPECT_EQ(failing.end, ScriptEnd::runtime_error) << failing.error.message;
  EXPECT_EQ(failing.line, 2) << failing.error.message;
  EXPECT_TRUE(is_back());
}

}  // namespace
}  // namespace ur_ros_rtde::test
