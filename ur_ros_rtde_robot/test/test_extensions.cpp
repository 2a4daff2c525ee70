// Extensions that the controller rejects, with the log messages and the errors of their goals; failing
// extensions.
#include <stdexcept>

#include "robot_fixture.hpp"
#include "ur_ros_rtde_robot/script/script_extension.hpp"

namespace ur_ros_rtde::test {
namespace {

struct ExtensionsTest : RobotFixture {
  static ScriptExtension of_urcap(const std::string & name, const std::string & snippet)
  {
    ScriptExtension extension;
    extension.name = name;
    extension.snippet = snippet;
    extension.urcap = "the Feeder URCap";
    extension.urcap_functions = {"feeder_open", "feeder_close"};
    return extension;
  }

  void start_with(const std::vector<ScriptExtension> & extensions)
  {
    controller.start();
    robot = std::make_unique<Robot>(robot_options(), log.function());
    ASSERT_TRUE(robot->set_extensions(extensions).empty());
    robot->start();
    ASSERT_TRUE(becomes_ready());
  }
};

TEST_F(ExtensionsTest, AMissingUrcapIsOneLineOfInformationForAllCommandsThatNeedIt)
{
  start_with(
      {of_urcap("close", "feeder_close(1)"), of_urcap("open", "feeder_open(1)"), of_urcap("wait", "sync()")});
  EXPECT_EQ(log.count("the Feeder URCap (for close, open)"), 1U) << log.text();
  EXPECT_EQ(log.count("[info] not installed on this robot"), 1U) << log.text();
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

}  // namespace
}  // namespace ur_ros_rtde::test
