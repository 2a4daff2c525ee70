#include <memory>
#include <string>
#include <utility>

#include "primary_messages.hpp"
#include "program/execution/script_monitor.hpp"
#include "reply_server.hpp"
#include "state_receiver_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

/// The simulator has the ports of own_address(), whose last number is never 1.
std::string other_address()
{
  const auto own = own_address();
  return own.substr(0, own.rfind('.')) + ".1";
}

/// A controller with a receiver of its state, and a primary interface whose messages the test determines.
struct ScriptMonitorTest : StateReceiverTest {
  const ScriptMonitor::Markers markers{"begins", "ends"};
  const decltype(script::make_program({}, {})) program =
      script::make_program("sync()", {false, markers.begin, markers.end, ""});
  ur_fuzz::ReplyServer primary_interface{other_address(), 30001};  // closes a connection that is shut down
  std::unique_ptr<StateReceiver> state;

  void SetUp() override
  {
    controller.start();
    state = receiver();
    ASSERT_TRUE(connected(*state));
    ASSERT_TRUE(program);
  }
  static PrimaryConnection connect()
  {
    auto connection = PrimaryConnection::connect(other_address(), 5s);
    EXPECT_TRUE(connection) << connection.error().message;
    return std::move(connection).value();
  }
  /// The end of a script whose name the controller reports like this, before its first line.
  ScriptReport report_with_name(const std::string & name, const std::string & reported)
  {
    const auto named =
        script::make_program("def " + name + "():\n  sync()\nend", {false, markers.begin, markers.end, ""});
    primary_interface.set_reply(primary::text("hello"), primary::key("PROGRAM_XXX_STARTED", reported) +
                                                            primary::key("PROGRAM_XXX_STOPPED", reported));
    const ScriptOptions options;
    ScriptMonitor monitor(connect(), *state, markers, options);
    monitor.run(named.value());
    return monitor.report();
  }
};

TEST_F(ScriptMonitorTest, EndsAtOnceIfTheScriptIsStoppedBeforeItsFirstLine)
{
  primary_interface.set_reply(primary::text("hello"), primary::key("PROGRAM_XXX_STARTED", program->name) +
                                                          primary::key("PROGRAM_XXX_STOPPED", program->name));
  const ScriptOptions options;
  ScriptMonitor monitor(connect(), *state, markers, options);
  monitor.run(*program);
  EXPECT_EQ(monitor.report().end, ScriptEnd::stopped) << monitor.report().error.message;
  EXPECT_FALSE(monitor.may_be_running());
  EXPECT_LT(monitor.report().duration, 2.5) << "not by the limit for the begin";
}

TEST_F(ScriptMonitorTest, EndsAScriptThatIsPausedBeforeItsFirstLine)
{
  controller.control(
      {{"command", "run_script"}, {"script", "def f():\n  while True:\n    sync()\n  end\nend\n"}});
  const auto is = [this](RuntimeState wanted) {
    return eventually([&] { return state->latest()->runtime_state == wanted; });
  };
  ASSERT_TRUE(is(RuntimeState::playing));
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(is(RuntimeState::paused));
  primary_interface.set_reply(primary::text("hello"), primary::key("PROGRAM_XXX_STARTED", program->name));
  const ScriptOptions options;
  ScriptMonitor monitor(connect(), *state, markers, options);
  bool is_compiled = false;
  monitor.on_compiled = [&is_compiled] { is_compiled = true; };
  monitor.run(*program);
  EXPECT_EQ(monitor.report().end, ScriptEnd::robot_stopped) << monitor.report().error.message;
  EXPECT_TRUE(monitor.may_be_running() && is_compiled) << "a stop ends it";
}

/// A stop may have to wait for the begin of a script, or for what tells that it will not begin.
TEST_F(ScriptMonitorTest, ListensOnAfterAStopOfAScriptThatHasBeenSent)
{
  primary_interface.set_reply(primary::text("hello"), primary::key("PROGRAM_XXX_STARTED", program->name));
  ScriptOptions options;
  ScriptMonitor * fenced = nullptr;
  options.stop_reason = [&fenced, asked = false]() mutable -> std::optional<Error> {
    if (!std::exchange(asked, true)) {
      return std::nullopt;  // the script is sent
    }
    fenced->fence();
    return Error{ErrorCode::canceled, "canceled"};
  };
  ScriptMonitor monitor(connect(), *state, markers, options);
  fenced = &monitor;
  monitor.run(*program);
  EXPECT_EQ(monitor.report().end, ScriptEnd::interrupted) << monitor.report().error.message;
  constexpr int enough = 50;
  int asked = 0;
  monitor.read_until_compiled([&asked] { return ++asked == enough; });
  EXPECT_EQ(asked, enough) << "the connection is closed";
}

TEST_F(ScriptMonitorTest, RecognizesTheBeginningOfALongNameAndNoOther)
{
  const std::string name(40, 'x');
  EXPECT_EQ(report_with_name(name, name.substr(0, 31)).end, ScriptEnd::stopped);
  for (const std::string & other : {name.substr(0, 30), std::string(31, 'y'), name + "x"}) {
    const ScriptReport report = report_with_name(name, other);
    EXPECT_NE(report.error.message.find("another program, `" + other + "`"), std::string::npos)
        << report.error.message;
  }
}

}  // namespace
}  // namespace ur_ros_rtde::test
