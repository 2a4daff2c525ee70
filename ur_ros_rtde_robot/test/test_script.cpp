#include <atomic>
#include <thread>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

struct ScriptTest : RobotFixture {
  static ScriptOptions secondary()
  {
    ScriptOptions options;
    options.kind = ScriptKind::secondary;
    options.timeout = 5s;
    return options;
  }

  /// A long joint motion.
  static std::string turning()
  {
    return "def turn():\n"
           "  q = get_actual_joint_positions()\n"
           "  q[0] = q[0] + 3\n"
           "  movej(q, a=2, v=0.8)\n"
           "end\n";
  }

  /// Calls `event` once, while the script moves the arm.
  ScriptOptions when_it_turns(std::function<void()> event)
  {
    ScriptOptions options;
    options.stop_reason = [this, event = std::move(event),
                           told = std::make_shared<std::atomic<bool>>(false)]() -> std::optional<Error> {
      if (turns() && !told->exchange(true)) {
        event();
      }
      return std::nullopt;
    };
    return options;
  }

  /// Stops a script when the control program has yielded to it, and returns the generation of that moment.
  Generation stop_before_begin(const std::function<void()> & event)
  {
    Generation received;
    ScriptOptions options;
    options.stop_reason = [&]() -> std::optional<Error> {
      received = robot->generation();
      event();
      return stopped_by_the_driver();
    };
    EXPECT_EQ(run_script(turning(), options).end, ScriptEnd::rejected);
    return received;
  }

  bool plays() { return controller.state().at("program").at("state") == "PLAYING"; }

  bool turns() { return std::abs(robot->latest()->actual_qd[0]) > 0.7; }

  /// The control program runs again and accepts commands.
  testing::AssertionResult is_back()
  {
    if (const auto ready = robot->ready_to_move(); !ready) {
      return testing::AssertionFailure() << ready.error().message << "\n" << log.text();
    }
    const auto q = robot->receive()->getActualQ();
    const auto mark = robot->mark_motion();
    auto there = q;
    there[5] += 0.02;
    if (!control()->moveJ(there, 1.0, 2.0, true) ||
        !eventually([&] { return robot->motion_progress(mark).finished(); })) {
      return testing::AssertionFailure() << "the arm does not move\n" << log.text();
    }
    return testing::AssertionSuccess();
  }
};

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

TEST_F(ScriptTest, StopsTheArmWhenCanceled)
{
  make_both();
  ScriptOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    return turns() ? std::optional(Error{ErrorCode::canceled, "enough"}) : std::nullopt;
  };
  recording = true;
  const auto report = run_script(turning(), options);
  recording = false;
  EXPECT_EQ(report.end, ScriptEnd::interrupted);
  EXPECT_EQ(report.error.code, ErrorCode::canceled);
  EXPECT_EQ(report.error.message, "enough");
  EXPECT_TRUE(at_rest());
  EXPECT_LT(highest_deceleration(0), 20.0) << "the arm decelerates";
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, StopsTheArmAtItsTimeLimit)
{
  make_both();
  ScriptOptions options;
  options.timeout = 700ms;
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::timeout);
  EXPECT_EQ(report.error.code, ErrorCode::timeout);
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, DoesNotCountAsFinishedWhenStoppedOnThePendant)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "stop_program"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::stopped);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsEndedIfItIsPausedSoThatItCannotResume)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "pause_program"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(controller.state().at("program").at("state") != "PAUSED");
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsEndedIfItIsPausedBeforeASampleHasShownItRunning)
{
  make_both();
  ScriptOptions options;
  options.timeout = 10s;
  options.on_text = [&](const std::string &) {  // with the marker of its begin
    controller.control({{"command", "pause_program"}});
    ASSERT_TRUE(eventually([&] { return robot->latest()->runtime_state == RuntimeState::paused; }));
  };
  const auto report =
      run_script("def f():\n  textmsg(\"on\")\n  while True:\n    sync()\n  end\nend\n", options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, MayBePausedIfItsCallerWaits)
{
  make_both();
  ScriptOptions options;
  options.may_be_paused = true;
  std::optional<double> paused;  // in the robot's time
  options.stop_reason = [&, resumed = false]() mutable -> std::optional<Error> {
    const double now = robot->latest()->controller_time;
    if (!paused && turns()) {
      controller.control({{"command", "pause_program"}});
      paused = now;
    } else if (paused && !resumed && now > *paused + 0.3) {
      controller.control({{"command", "play"}});
      resumed = true;
    }
    return std::nullopt;
  };
  const auto report = run_script("movej([1, -1.5, 1.5, -1.5, -1.5, 0], a=5, v=2)\n", options);
  EXPECT_EQ(report.end, ScriptEnd::finished) << report.error.message;
  EXPECT_TRUE(paused);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, LeavesAProgramAloneThatReplacesTheScript)
{
  make_both();
  const auto options = when_it_turns([&] { controller.run_other_program(); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::stopped);
  EXPECT_NE(report.error.message.find("another program, `other`"), std::string::npos) << report.error.message;
  EXPECT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready());
  EXPECT_TRUE(is_back());
}

/// Nothing tells yet that the control program is gone: its heartbeat may be missing for 50 ms.
TEST_F(ScriptTest, IsNotSentAfterAProgramThatHasReplacedTheControlProgram)
{
  make_both();
  controller.control({{"command", "run_script"}, {"script", "def other():\n  sleep(0.3)\nend\n"}});
  const auto report = run_script(turning());
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(becomes_ready_again());
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, LeavesAProgramAloneThatHasReplacedTheControlProgram)
{
  make_both();
  controller.run_other_program();
  const auto report = run_script(turning());
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(plays()) << log.text();
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready_again());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsNotSentAfterAProgramThatBeganInItsPlace)
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

TEST_F(ScriptTest, EndsInAProtectiveStopWithoutResuming)
{
  make_both();
  const auto options =
      when_it_turns([&] { controller.control({{"command", "protective_stop"}, {"reason", "test"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  EXPECT_EQ(report.error.code, ErrorCode::protective_stop);
  EXPECT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  const double before = robot->latest()->actual_q[0];
  ASSERT_TRUE(eventually(
      [&] {
        try {
          robot->dashboard()->unlockProtectiveStop();
          return true;
        } catch (const std::exception &) {
          return false;
        }
      },
      20s));
  ASSERT_TRUE(becomes_ready());
  EXPECT_NEAR(robot->latest()->actual_q[0], before, 0.01);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsEndedInASafeguardStopSoThatItCannotResume)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "safeguard"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  EXPECT_EQ(report.error.code, ErrorCode::safeguard_stop);
  // A paused program resumes when the safeguard closes.
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  controller.control({{"command", "safeguard"}, {"open", false}});
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(is_back());
}

/// In local control, the dashboard server does not stop it.
TEST_F(ScriptTest, IsLeftToItsWatchdogIfItCannotBeEndedInASafeguardStop)
{
  make_both();
  const auto options = when_it_turns([&] {
    controller.control({{"command", "remote_control"}, {"on", false}});
    controller.control({{"command", "safeguard"}});
  });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  const double before = robot->latest()->actual_q[0];
  controller.control({{"command", "safeguard"}, {"open", false}});
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_NEAR(robot->latest()->actual_q[0], before, 0.1) << "the script went on";
  controller.control({{"command", "remote_control"}});
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, EndsWithTheLink)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "drop_links"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::link_lost);
  EXPECT_EQ(report.error.code, ErrorCode::link_lost);
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptTest, IsStoppedByItsWatchdogWithoutSignsOfLife)
{
  make_both();
  const auto options = when_it_turns([&] {
    controller.control({{"command", "stall_links"}, {"which", "rtde"}});
    EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
    controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"stalled", false}});
  });
  const auto report = run_script(turning(), options);
  EXPECT_FALSE(report);
  EXPECT_TRUE(becomes_ready());
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

TEST_F(ScriptTest, StopsAtItsTimeLimitWhileItWritesFasterThanTheCallbackReturns)
{
  make_both();
  ScriptOptions options;
  options.timeout = 1s;
  const auto begin = Clock::now();
  options.on_text = [&](const std::string &) {
    if (Clock::now() - begin < 20s) {
      std::this_thread::sleep_for(20ms);
    }
  };
  const auto report =
      run_script("def f():\n  while True:\n    textmsg(\"x\")\n    sync()\n  end\nend\n", options);
  EXPECT_EQ(report.end, ScriptEnd::timeout) << report.error.message;
  EXPECT_LT(Clock::now() - begin, 10s);
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

TEST_F(ScriptTest, IsNotSentForAGoalThatHasToEnd)
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

TEST_F(ScriptTest, IsEndedIfItBeginsLongAfterTheStop)
{
  make_both();
  const double begin = robot->latest()->actual_q[0];
  const auto compile_in = [this](double seconds) {
    controller.control({{"command", "compile_time"}, {"seconds", seconds}});
  };
  ScriptOptions options;
  options.stop_reason = [calls = 0, &compile_in]() mutable -> std::optional<Error> {
    if (calls++ > 0) {  // it was sent
      return Error{ErrorCode::canceled, "canceled"};
    }
    compile_in(1.0);
    return std::nullopt;
  };
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.error.code, ErrorCode::canceled) << report.error.message;
  EXPECT_TRUE(at_rest());
  compile_in(0.0);
  EXPECT_TRUE(is_back());
  EXPECT_NEAR(robot->latest()->actual_q[0], begin, 0.05);
}

TEST_F(ScriptTest, DoesNotEndAGoalThatWaitsForTheArmSinceBeforeItsBegin)
{
  make_both();
  const Generation received = stop_before_begin([] {});
  ASSERT_TRUE(becomes_ready());
  const Status continued = robot->is_continued(received);
  EXPECT_TRUE(continued) << continued.error().message;
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(eventually([&] { return !robot->is_continued(received); })) << "an operator has stopped it";
}

TEST_F(ScriptTest, DoesNotEndAGoalThatComesWhileTheControlProgramReturns)
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

TEST_F(ScriptTest, EndsAGoalThatWaitsForTheArmIfTheControlProgramDoesNotReturnAtOnce)
{
  make_both();
  const Generation received = stop_before_begin([&] {  // it begins, but does not answer
    controller.control(
        {{"command", "lose_commands"}, {"which", "rtde"}, {"clients", "control"}, {"count", 100000}});
  });
  ASSERT_TRUE(becomes_ready());
  EXPECT_FALSE(robot->is_continued(received)) << "an operator may have stopped it";
}

TEST_F(ScriptTest, IsNotSentAsSecondaryProgramAfterACancelThatTheThreadHasNotSeen)
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
