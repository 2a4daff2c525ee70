// What ends a script before it has finished.
#include <thread>

#include "script_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;

using ScriptEndTest = ScriptTest;

TEST_F(ScriptEndTest, StopsTheArmWhenCanceled)
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

TEST_F(ScriptEndTest, StopsTheArmAtItsTimeLimit)
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

TEST_F(ScriptEndTest, DoesNotCountAsFinishedWhenStoppedOnThePendant)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "stop_program"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::stopped);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped);
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptEndTest, IsALostConnectionIfThatEndsItByItsWatchdog)
{
  auto robot_options = test::robot_options();
  robot_options.watchdog_frequency = 10.0;
  make_both(robot_options);
  const auto options = when_it_turns(
      [&] { controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "control"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.error.code, ErrorCode::link_lost) << report.error.message;
  EXPECT_TRUE(report.error.message.starts_with("the connection that feeds the watchdog"))
      << report.error.message;
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptEndTest, NamesTheLateHostIfItsWatchdogEndsIt)
{
  auto robot_options = test::robot_options();
  robot_options.watchdog_frequency = 10.0;
  robot_options.silence_limit = 2000ms;
  std::atomic<bool> is_late = false;
  on_sample = [&is_late](const Sample &) {
    if (is_late.exchange(false)) {
      std::this_thread::sleep_for(300ms);
    }
  };
  make_both(robot_options);
  const auto report = run_script(turning(), when_it_turns([&] { is_late = true; }));
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(report.error.message.starts_with("the watchdog of the script stopped it: this host sent"))
      << report.error.message;
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptEndTest, IsEndedIfItIsPausedSoThatItCannotResume)
{
  make_both();
  const auto options = when_it_turns([&] { controller.control({{"command", "pause_program"}}); });
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.end, ScriptEnd::robot_stopped);
  EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
  EXPECT_TRUE(controller.state().at("program").at("state") != "PAUSED");
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptEndTest, IsEndedIfItIsPausedBeforeASampleHasShownItRunning)
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

/// The driver does not know yet what the operator has done to the control program when it asks it to yield.
struct LateScriptTest : ScriptTest {
  std::atomic<bool> operates = false;
  std::atomic<bool> has_operated = false;

  void make(const std::string & command, std::chrono::milliseconds lateness)
  {
    on_sample = [this, command, lateness](const Sample &) {
      if (operates.exchange(false)) {
        controller.control({{"command", command}});
        has_operated = true;
        std::this_thread::sleep_for(lateness);
      }
    };
    auto options = robot_options();
    options.silence_limit = 2000ms;
    make_both(options);
  }
  /// Sends a script right after the operator has acted, and lets its holder try to go on.
  void expect_rejection()
  {
    const auto lease = robot->acquire(claim(Resource::script));
    ASSERT_TRUE(lease);
    operates = true;
    ASSERT_TRUE(eventually([&] { return has_operated.load(); }));
    const auto report = robot->run_script(*lease, turning());
    EXPECT_EQ(report.end, ScriptEnd::rejected);
    EXPECT_EQ(report.error.code, ErrorCode::program_stopped) << report.error.message;
    EXPECT_TRUE(eventually([&] { return robot->ready_to_move().has_value(); }));
    EXPECT_FALSE(robot->may_continue(*lease));
  }
};

TEST_F(LateScriptTest, DoesNotBeginAfterAPauseOfTheControlProgram)
{
  make("pause_program", 100ms);
  expect_rejection();
}

TEST_F(LateScriptTest, DoesNotBeginAfterAPauseThatIsSeenLate)
{
  make("pause_program", 400ms);
  expect_rejection();
}

TEST_F(LateScriptTest, DoesNotBeginAfterAStopThatIsSeenLate)
{
  make("stop_program", 400ms);
  expect_rejection();
}

TEST_F(ScriptEndTest, MayBePausedIfItsCallerWaits)
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
  auto lease = robot->acquire(claim(Resource::script));
  ASSERT_TRUE(lease);
  const auto report = robot->run_script(*lease, "movej([1, -1.5, 1.5, -1.5, -1.5, 0], a=5, v=2)\n", options);
  EXPECT_EQ(report.end, ScriptEnd::finished) << report.error.message;
  EXPECT_TRUE(paused);
  EXPECT_TRUE(robot->may_continue(*lease)) << "its holder may go on";
  *lease = {};
  EXPECT_TRUE(is_back());
}

TEST_F(ScriptEndTest, LeavesAProgramAloneThatReplacesTheScript)
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

TEST_F(ScriptEndTest, LeavesAProgramAloneThatHasReplacedTheControlProgram)
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

TEST_F(ScriptEndTest, EndsInAProtectiveStopWithoutResuming)
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

TEST_F(ScriptEndTest, IsEndedInASafeguardStopSoThatItCannotResume)
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
TEST_F(ScriptEndTest, IsLeftToItsWatchdogIfItCannotBeEndedInASafeguardStop)
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

TEST_F(ScriptEndTest, EndsWithTheLink)
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

TEST_F(ScriptEndTest, IsStoppedByItsWatchdogWithoutSignsOfLife)
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

TEST_F(ScriptEndTest, StopsAtItsTimeLimitWhileItWritesFasterThanTheCallbackReturns)
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

TEST_F(ScriptEndTest, IsEndedByItsWatchdogIfItBeginsLongAfterAStopInLocalControl)
{
  auto robot_options = test::robot_options();
  robot_options.watchdog_frequency = 1.0;
  make_both(robot_options);
  controller.control({{"command", "compile_time"}, {"seconds", 1.0}});
  ScriptOptions options;
  options.stop_reason = [calls = 0, this]() mutable -> std::optional<Error> {
    if (calls++ > 0) {  // it was sent
      controller.control({{"command", "remote_control"}, {"on", false}});
      return Error{ErrorCode::canceled, "canceled"};
    }
    return std::nullopt;
  };
  const auto report = run_script(turning(), options);
  EXPECT_EQ(report.error.code, ErrorCode::canceled) << report.error.message;
  EXPECT_TRUE(at_rest());
  EXPECT_FALSE(eventually([&] { return !at_rest(); }, 1500ms)) << "it begins after its end";
}

TEST_F(ScriptEndTest, IsEndedIfItBeginsLongAfterTheStop)
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

}  // namespace
}  // namespace ur_ros_rtde::test
