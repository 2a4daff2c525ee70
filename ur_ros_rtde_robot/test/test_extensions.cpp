// Extensions that the controller rejects, with the log messages and the errors of their goals; failing
// extensions; what is left of an extension that has ended.
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "robot_fixture.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"

namespace ur_ros_rtde::test {
namespace {

struct ExtensionsTest : RobotFixture {
  static ScriptExtension extension(const std::string & name, const std::string & snippet)
  {
    ScriptExtension result;
    result.name = name;
    result.snippet = snippet;
    return result;
  }

  static ScriptExtension of_urcap(const std::string & name, const std::string & snippet)
  {
    ScriptExtension result = extension(name, snippet);
    result.urcap = "the Feeder URCap";
    result.urcap_functions = {"feeder_open", "feeder_close"};
    return result;
  }

  void start_with(const std::vector<ScriptExtension> & extensions)
  {
    controller.start();
    robot = std::make_unique<Robot>(robot_options(), log.function());
    ASSERT_TRUE(robot->set_extensions(extensions).empty());
    robot->start();
    ASSERT_TRUE(becomes_ready());
  }

  /// "freedrive" or "force_mode"
  bool is_on(const char * mode) { return controller.state().at(mode).get<bool>(); }
};

TEST_F(ExtensionsTest, AMissingUrcapIsOneLineOfInformationForAllCommandsThatNeedIt)
{
  start_with(
      {of_urcap("close", "feeder_close(1)"), of_urcap("open", "feeder_open(1)"), of_urcap("wait", "sync()")});
  EXPECT_EQ(log.count("the Feeder URCap (for close, open)"), 1U) << log.text();
  EXPECT_EQ(log.count("[info] unknown in programs of the driver"), 1U) << log.text();
  EXPECT_EQ(log.count("[error]"), 0U) << log.text();
  EXPECT_TRUE(robot->has_extension("wait"));
  const auto rejected = robot->has_extension("open");
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error().code, ErrorCode::not_supported);
  EXPECT_NE(rejected.error().message.find("feeder_open"), std::string::npos) << rejected.error().message;
  EXPECT_NE(rejected.error().message.find("install the Feeder URCap"), std::string::npos)
      << rejected.error().message;
}

TEST_F(ExtensionsTest, AFaultInASnippetStaysAnError)
{
  start_with({of_urcap("typo", "feder_open(1)"), of_urcap("wait", "sync()")});
  EXPECT_EQ(log.count("[error] the extension typo is left out"), 1U) << log.text();
  EXPECT_EQ(log.count("not installed"), 0U) << log.text();
  EXPECT_FALSE(robot->has_extension("typo"));
  EXPECT_TRUE(robot->has_extension("wait"));
}

TEST_F(ExtensionsTest, CodeThatIsIncompleteInThisVersionOfTheControllerIsLeftOutAlone)
{
  start_with({extension("half", "$5.90 if True:\n  sync()\nend"), extension("wait", "sync()")});
  EXPECT_EQ(log.count("[error] the extension half is left out: with PolyScope"), 1U) << log.text();
  const auto rejected = robot->has_extension("half");
  ASSERT_FALSE(rejected);
  EXPECT_NE(rejected.error().message.find("its code is not complete"), std::string::npos)
      << rejected.error().message;
  EXPECT_TRUE(run_extension("wait")) << log.text();
}

TEST_F(ExtensionsTest, ATypoBesideAMissingUrcapIsToldApartFromIt)
{
  start_with({of_urcap("open", "feeder_open(1)"), of_urcap("typo", "x = feeder_opened")});
  EXPECT_EQ(log.count("[error] the extension typo is left out"), 1U) << log.text();
  EXPECT_EQ(log.count("the Feeder URCap (for open)"), 1U) << log.text();
}

TEST_F(ExtensionsTest, AnExtensionIsStoppedWhenACallbackThrows)
{
  ScriptExtension turn;
  turn.name = "turn";
  turn.snippet = "speedj([0.05, 0, 0, 0, 0, 0], 2.0, 60.0)\n";
  start_with({turn});
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    if (robot->is_moving()) {
      throw std::runtime_error("thrown");
    }
    return std::nullopt;
  };
  EXPECT_THROW((void)run_extension("turn", options), std::runtime_error);
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
}

/// A stop whose message to the control program is lost takes the next means, and the next extension runs.
TEST_F(ExtensionsTest, AreStoppedEvenIfTheMessageIsLost)
{
  ScriptExtension turn;
  turn.name = "turn";
  turn.snippet = "speedj([0.3, 0, 0, 0, 0, 0], 2.0, 60.0)\n";
  ScriptExtension wait;
  wait.name = "wait";
  wait.snippet = "sync()\n";
  start_with({turn, wait});
  double begin = 0.0;
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    if (robot->latest()->actual_qd[0] < 0.28) {
      return std::nullopt;
    }
    controller.control({{"command", "lose_commands"}, {"which", "rtde"}, {"clients", "io"}});
    begin = robot->latest()->controller_time;
    recording = true;
    return Error{ErrorCode::canceled, "canceled"};
  };
  const Status ended = run_extension("turn", options);
  EXPECT_EQ(ended.error().code, ErrorCode::canceled) << ended.error().message;
  EXPECT_TRUE(at_rest());
  EXPECT_LT(robot->latest()->controller_time - begin, 1.0);
  ASSERT_TRUE(eventually([&] { return static_cast<bool>(robot->ready_to_move()); })) << log.text();
  EXPECT_TRUE(run_extension("wait")) << log.text();
}

/// A stop takes the next means if another thread holds the IO interface.
TEST_F(ExtensionsTest, AreStoppedWhileAnotherThreadHoldsTheIoInterface)
{
  start_with({extension("turn", "speedj([0.3, 0, 0, 0, 0, 0], 2.0, 60.0)\n")});
  double begin = 0.0;
  std::atomic<bool> holds{false};
  std::atomic<bool> release{false};
  std::jthread holder;
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    if (robot->latest()->actual_qd[0] < 0.28) {
      return std::nullopt;
    }
    holder = std::jthread([&] {
      const auto held = robot->io().hold();
      holds = true;
      eventually([&] { return release.load(); }, 2s);
    });
    EXPECT_TRUE(eventually([&] { return holds.load(); }));
    begin = robot->latest()->controller_time;
    return Error{ErrorCode::canceled, "canceled"};
  };
  const Status ended = run_extension("turn", options);
  const double duration = robot->latest()->controller_time - begin;
  release = true;
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().message, "canceled");
  EXPECT_TRUE(at_rest());
  EXPECT_LT(duration, 1.0);
}

/// An extension that turns the arm and loses the connection of its trigger.
struct LostConnectionTest : ExtensionsTest {
  double begin = 0.0;  ///< of the loss, controller time in s

  Status run_and_lose(const std::function<void()> & before_loss)
  {
    start_with({extension("turn", "speedj([0.3, 0, 0, 0, 0, 0], 2.0, 60.0)\n")});
    ExtensionOptions options;
    options.stop_reason = [&]() -> std::optional<Error> {
      if (begin == 0.0 && robot->latest()->actual_qd[0] > 0.28) {
        before_loss();
        controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "io"}});
        begin = robot->latest()->controller_time;
      }
      return std::nullopt;
    };
    return run_extension("turn", options);
  }
};

/// The controller keeps the trigger of a lost connection; the next connection clears it.
TEST_F(LostConnectionTest, EndsTheExtension)
{
  const Status ended = run_and_lose([] {});
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::link_lost) << ended.error().message;
  EXPECT_LT(robot->latest()->controller_time - begin, 1.0);
  EXPECT_TRUE(at_rest());
}

/// Without a connection, nothing clears the trigger, and the extension goes on.
TEST_F(LostConnectionTest, EndsTheExtensionEvenIfItStaysLost)
{
  const Status ended =
      run_and_lose([this] { controller.control({{"command", "refuse_connections"}, {"which", "rtde"}}); });
  const double duration = robot->latest()->controller_time - begin;
  controller.control({{"command", "accept_connections"}, {"which", "rtde"}});
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::link_lost) << ended.error().message;
  EXPECT_NE(ended.error().message.find("the IO connection was lost"), std::string::npos)
      << ended.error().message;
  EXPECT_LT(duration, 5.0);
  EXPECT_TRUE(at_rest());
}

TEST_F(ExtensionsTest, FailIfTheirTriggerIsLost)
{
  start_with({extension("wait", "sync()\n")});
  const double begin = robot->latest()->controller_time;
  // The trigger is cleared before it is set.
  controller.control({{"command", "lose_commands"}, {"which", "rtde"}, {"clients", "io"}, {"count", 2}});
  const Status ended = run_extension("wait");
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::timeout);
  EXPECT_NE(ended.error().message.find("has not begun the extension wait"), std::string::npos)
      << ended.error().message;
  EXPECT_LT(robot->latest()->controller_time - begin, 5.0);
  ASSERT_TRUE(eventually([&] { return static_cast<bool>(robot->ready_to_move()); })) << log.text();
  EXPECT_TRUE(run_extension("wait")) << log.text();
}

TEST_F(ExtensionsTest, EndWithTheReasonOfAStopThatTheirCallerDoesNotNotice)
{
  start_with({extension("turn", "speedj([0.3, 0, 0, 0, 0, 0], 2.0, 60.0)\n")});
  std::jthread stop([&] {
    ASSERT_TRUE(eventually([&] { return robot->latest()->actual_qd[0] > 0.28; }));
    EXPECT_TRUE(robot->stop_motion());
  });
  const Status ended = run_extension("turn");
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().message, stopped_by_the_driver().message);
}

/// Freedrive does not belong to the thread of the snippet, and ignores a stop of the motion.
TEST_F(ExtensionsTest, FreedriveEndsWithACanceledOne)
{
  start_with({extension("guide", "freedrive_mode()\nwhile True:\n  sync()\nend\n")});
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    return is_on("freedrive") ? std::optional(Error{ErrorCode::canceled, "canceled"}) : std::nullopt;
  };
  const Status ended = run_extension("guide", options);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::canceled) << ended.error().message;
  EXPECT_FALSE(is_on("freedrive"));
  EXPECT_TRUE(at_rest());
}

TEST_F(ExtensionsTest, ModesEndWithOneThatHasFinished)
{
  start_with({extension("press",
                        "force_mode(p[0, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 0], 2, "
                        "[0.1, 0.1, 0.05, 0.1, 0.1, 0.1])\n"),
              extension("teach", "teach_mode()\n")});
  for (const char * name : {"press", "teach"}) {
    EXPECT_TRUE(run_extension(name)) << log.text();
    EXPECT_FALSE(is_on("force_mode"));
    EXPECT_FALSE(is_on("freedrive"));
  }
}

/// Such as the mode of a command that runs the extension.
TEST_F(ExtensionsTest, DoNotEndAModeThatTheyDoNotStart)
{
  start_with({extension("wait", "sync()\n"), extension("guide", "freedrive_mode()\n")});
  Claim switching = claim();
  switching.switches_hand_guiding = true;
  const auto lease = robot->acquire(switching);
  ASSERT_TRUE(lease);
  ASSERT_TRUE(robot->control(*lease)->freedriveMode());
  ASSERT_TRUE(eventually([&] { return is_on("freedrive"); }));
  EXPECT_TRUE(robot->run_extension(*lease, "wait")) << log.text();
  EXPECT_TRUE(is_on("freedrive"));
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_FALSE(is_on("freedrive"));
}

TEST_F(ExtensionsTest, AreStoppedBeforeTheModeOfACommand)
{
  start_with({extension("loop", "while True:\n  sync()\nend\n")});
  Claim switching = claim();
  switching.switches_hand_guiding = true;
  const auto lease = robot->acquire(switching);
  ASSERT_TRUE(lease);
  ASSERT_TRUE(robot->control(*lease)->freedriveMode());
  ASSERT_TRUE(eventually([&] { return is_on("freedrive"); }));
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    return robot->activities().contains(Activity::extension)
               ? std::optional(Error{ErrorCode::canceled, "canceled"})
               : std::nullopt;
  };
  const auto generation = robot->generation();
  EXPECT_EQ(robot->run_extension(*lease, "loop", options).error().code, ErrorCode::canceled) << log.text();
  EXPECT_FALSE(is_on("freedrive"));
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_TRUE(robot->is_current(generation)) << "the control program goes on";
}

TEST_F(ExtensionsTest, AreStoppedBeforeTheContactDetectionOfACommand)
{
  start_with(
      {extension("turn", "q = get_target_joint_positions()\nq[0] = q[0] + 2\nmovej(q, a=2, v=0.5)\n")});
  const auto lease = robot->acquire(claim());
  ASSERT_TRUE(lease);
  ASSERT_TRUE(robot->control(*lease)->startContactDetection({0.0, 0.0, -1.0, 0.0, 0.0, 0.0}));
  ExtensionOptions options;
  options.stop_reason = [&]() -> std::optional<Error> {
    return robot->latest()->actual_qd[0] > 0.4 ? std::optional(Error{ErrorCode::canceled, "canceled"})
                                               : std::nullopt;
  };
  const auto generation = robot->generation();
  EXPECT_EQ(robot->run_extension(*lease, "turn", options).error().code, ErrorCode::canceled) << log.text();
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_FALSE(robot->is_moving());
  EXPECT_TRUE(robot->is_current(generation)) << "the control program goes on";
}

TEST_F(ExtensionsTest, OnlyTheirInputRegistersAreWritten)
{
  robot = std::make_unique<Robot>(robot_options(), log.function());
  for (int number = -1; number < 48; ++number) {
    const ErrorCode expected =
        number >= 19 && number <= 22 ? ErrorCode::link_lost : ErrorCode::invalid_goal;  // there is no link
    EXPECT_EQ(robot->set_input_register(number, std::int32_t{1}).error().code, expected) << number;
    EXPECT_EQ(robot->set_input_register(number, 1.0).error().code, expected) << number;
  }
}

struct ContactDetectionTest : RobotFixture {
  static inline const std::vector<double> down{0.0, 0.0, -1.0, 0.0, 0.0, 0.0};
  int threads() { return controller.state().at("program").at("threads").get<int>(); }
};

TEST_F(ContactDetectionTest, NeedsALease)
{
  make_both();
  EXPECT_THROW(robot->control_for_queries()->startContactDetection(), std::logic_error);
  EXPECT_TRUE(control()->startContactDetection());
}

TEST_F(ContactDetectionTest, IsAnActivityUntilItIsStopped)
{
  make_both();
  EXPECT_TRUE(control()->startContactDetection(down));
  EXPECT_EQ(robot->activities(), Activities(Activity::contact_detection));
  EXPECT_FALSE(control()->stopContactDetection()) << "there was no contact";
  EXPECT_TRUE(robot->activities().empty());
}

/// Otherwise, a contact would stop the motion of the next goal.
TEST_F(ContactDetectionTest, EndsWithAStopOfAnArmAtRest)
{
  make_both_slow();
  const int before = threads();
  ASSERT_TRUE(control()->startContactDetection(down));
  ASSERT_TRUE(eventually([&] { return threads() == before + 1; })) << threads();
  const auto generation = robot->generation();
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_TRUE(eventually([&] { return threads() == before; })) << threads();
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_TRUE(robot->is_current(generation)) << "the control program goes on";
}

/// A contact after the stop would move the arm.
TEST_F(ContactDetectionTest, EndsWithAStop)
{
  make_both();
  const int before = threads();
  move_linear();
  ASSERT_TRUE(control()->startContactDetection());
  ASSERT_TRUE(eventually([&] { return threads() == before + 2; })) << threads();
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_TRUE(eventually([&] { return threads() == before; })) << threads();
}

TEST_F(ContactDetectionTest, LeavesTheControlProgramResponsive)
{
  make_both();
  auto pose = robot->latest()->actual_tcp_pose;
  const double surface = pose[2] - 0.02;
  controller.control({{"command", "place_surface"}, {"z", surface}});
  const auto lease = acquire();
  ASSERT_TRUE(robot->control(lease)->startContactDetection(down));
  const auto generation = robot->generation();
  pose[2] = surface - 0.05;
  ASSERT_TRUE(robot->control(lease)->moveL({pose.begin(), pose.end()}, 0.05, 0.5, true));
  const auto height = [&] { return robot->latest()->actual_tcp_pose[2]; };
  ASSERT_TRUE(eventually([&] { return height() < surface; }, 20s));
  EXPECT_TRUE(eventually([&] { return !robot->is_moving() && std::abs(height() - surface) < 2e-3; }, 20s))
      << height() - surface;
  EXPECT_TRUE(robot->control(lease)->readContactDetection());
  EXPECT_TRUE(robot->is_current(generation)) << "another program is said to run";
}

}  // namespace
}  // namespace ur_ros_rtde::test
