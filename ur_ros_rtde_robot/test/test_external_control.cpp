#include "program/script_server.hpp"
#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

struct ExternalControlTest : RobotFixture {
  const std::uint16_t port = free_port();

  RobotOptions options() const
  {
    RobotOptions result = robot_options();
    result.control_mode = ControlMode::control_urcap;
    result.urcap_port = port;
    return result;
  }

  void start(const RobotOptions & robot_options, bool remote_control = true)
  {
    auto simulator = Controller::options();
    simulator.remote_control = remote_control;
    controller.start(simulator);
    controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
    make_robot(robot_options);
    ASSERT_TRUE(waits_for_play());
  }

  void play() { controller.control({{"command", "play"}}); }

  /// The status tells the operator what to do.
  testing::AssertionResult waits_for_play()
  {
    if (!eventually(
            [&] {
              return robot->status().message.find("External Control node on the pendant") !=
                     std::string::npos;
            },
            10s)) {
      return testing::AssertionFailure() << robot->status().message << "\n" << log.text();
    }
    return comes_to(RobotState::stopped, ErrorCode::program_stopped);
  }

  /// The arm does not move for a while although the control program runs.
  testing::AssertionResult keeps_still()
  {
    const bool moves = eventually([&] { return !at_rest(); }, 400ms);
    return moves ? testing::AssertionFailure() << "it moves" : testing::AssertionSuccess();
  }

  testing::AssertionResult works()
  {
    auto there = robot->receive()->getActualQ();
    there[5] += 0.02;
    const auto mark = robot->mark_motion();
    if (!control()->moveJ(there, 1.0, 2.0, true) ||
        !eventually([&] { return robot->motion_progress(mark).finished(); })) {
      return testing::AssertionFailure() << "it does not move\n" << log.text();
    }
    return testing::AssertionSuccess();
  }
};

TEST_F(ExternalControlTest, BecomesReadyWhenTheProgramIsPlayed)
{
  start(options());
  EXPECT_NE(robot->status().message.find(std::to_string(port)), std::string::npos) << robot->status().message;
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  EXPECT_FALSE(robot->ready_to_move());
  EXPECT_FALSE(eventually([&] { return robot->latest()->is_program_running(); }, 400ms))
      << "nobody has played it";
  play();
  ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); })) << log.text();
  const double begin = robot->latest()->controller_time;
  ASSERT_TRUE(becomes_ready());
  const double after = robot->latest()->controller_time - begin;
  RecordProperty("ready_after_play_s", std::to_string(after));
  EXPECT_LT(after, 1.0);
  EXPECT_TRUE(robot->ready_to_move());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, LeavesCodeOutThatIsIncompleteInThisVersionOfTheController)
{
  controller.start();
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  robot = std::make_unique<Robot>(options(), log.function());
  ScriptExtension half;
  half.name = "half";
  half.snippet = "$5.90 if True:\n  sync()\nend";
  ASSERT_TRUE(robot->set_extensions({half}).empty());
  robot->start();
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready()) << log.text();
  EXPECT_EQ(log.count("[error] the extension half is left out"), 1U) << log.text();
  EXPECT_FALSE(robot->has_extension("half"));
}

/// PolyScope would not start a program with an unknown function.
TEST_F(ExternalControlTest, HasTheExtensionsOfAUrcapOnlyIfTheUserSaysThatItIsInstalled)
{
  auto simulator = Controller::options();
  simulator.urcaps = {"onrobot_soft_gripper"};
  controller.start(simulator);
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  ScriptExtension gripper;
  gripper.name = "gripper";
  gripper.snippet = "get_sg_Width()";
  gripper.urcap = "the OnRobot URCap";
  gripper.urcap_functions = {"get_sg_Width"};
  for (const bool is_installed : {false, true}) {
    auto robot_options = options();
    robot_options.urcap_extensions = is_installed;
    robot = std::make_unique<Robot>(robot_options, log.function());
    ASSERT_TRUE(robot->set_extensions({gripper}).empty());
    robot->start();
    ASSERT_TRUE(waits_for_play());
    play();
    ASSERT_TRUE(becomes_ready()) << log.text();
    const auto found = robot->has_extension("gripper");
    EXPECT_EQ(found.has_value(), is_installed);
    if (!found) {
      EXPECT_NE(found.error().message.find("urcap_extensions"), std::string::npos) << found.error().message;
    }
    robot.reset();
  }
}

TEST_F(ExternalControlTest, EndsTheMotionAndWaitsForPlayWhenStoppedOnThePendant)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::program_stopped);
  ASSERT_TRUE(waits_for_play());
  EXPECT_FALSE(eventually([&] { return robot->latest()->is_program_running(); }, 700ms))
      << "it was the operator";
  EXPECT_TRUE(at_rest());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DoesNotExecuteTheCommandOfAnEarlierProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  control()->speedJ({0.0, 0.0, 0.0, 0.0, 0.0, 0.3}, 2.0, 0.0);
  ASSERT_TRUE(eventually([&] { return !at_rest(); }));
  {
    const auto kept = robot->control_for_queries().hold();  // so that the driver is late to connect again
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(eventually([&] { return !robot->latest()->is_program_running() && at_rest(); }));
    play();
    ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); }));
    EXPECT_TRUE(keeps_still());
  }
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, EndsTheProgramWithItsNode)
{
  start(options());
  controller.control({{"command", "store_external_control"},
                      {"host", own_address()},
                      {"port", port},
                      {"next", "movej([1, -1.5, 1.5, -1.5, -1.5, 0], a=5, v=2)"}});
  play();
  ASSERT_TRUE(becomes_ready());
  // False if the driver has seen the end first, and abandons the command.
  static_cast<void>(control()->stopScript());
  ASSERT_TRUE(eventually([&] { return !robot->latest()->is_program_running(); }));
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, DoesNotResumeTheMotionOfAPausedProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, LeavesAPausedProgramToItsWatchdogInLocalControl)
{
  start(options(), false);
  play();
  ASSERT_TRUE(becomes_ready()) << "local control is where the URCap is for";
  move_joints();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, WaitsForPlayAfterLostLinksWithoutResumingTheMotion)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  std::size_t times = 1;
  for (const bool reset : {false, true}) {
    move_joints();
    controller.control({{"command", "drop_links"}, {"reset", reset}});
    ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
    ASSERT_TRUE(waits_for_play());
    EXPECT_FALSE(robot->latest()->is_program_running());
    play();
    ASSERT_TRUE(becomes_ready_again(++times));
    EXPECT_TRUE(keeps_still());
    EXPECT_TRUE(works());
  }
}

TEST_F(ExternalControlTest, WaitsForPlayAfterOnlyTheControlLinkWasLost)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "control"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DoesNotResumeTheMotionAfterAProtectiveStop)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  ASSERT_TRUE(eventually(
      [&] {
        try {
          robot->dashboard()->unlockProtectiveStop();  // rejected for 5 s
          return true;
        } catch (const std::exception &) {
          return false;
        }
      },
      20s));
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, WaitsForPlayAfterAReboot)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "reboot"}, {"duration", 0.3}});
  ASSERT_TRUE(comes_to(RobotState::disconnected, ErrorCode::link_lost));
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  controller.control({{"command", "power"}, {"to", "running"}});
  ASSERT_TRUE(waits_for_play());
  controller.control({{"command", "store_external_control"}, {"host", own_address()}, {"port", port}});
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(works());
}

TEST_F(ExternalControlTest, DistinguishesTheControlProgramFromAnotherOne)
{
  start(options());
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("not the control program") != std::string::npos;
  })) << robot->status().message;
  EXPECT_NE(robot->status().message.find("the External Control URCap has not fetched it"), std::string::npos);
  EXPECT_TRUE(robot->latest()->is_program_running()) << "it is left alone";
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  EXPECT_TRUE(becomes_ready());
}

TEST_F(ExternalControlTest, LeavesAForeignProgramAloneThatIsPaused)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("has replaced the control program") != std::string::npos;
  })) << robot->status().message;
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("will not be resumed") != std::string::npos;
  })) << robot->status().message;
  EXPECT_FALSE(eventually([&] { return controller.state().at("program").at("state") != "PAUSED"; }, 700ms));
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  EXPECT_TRUE(becomes_ready());
}

TEST_F(ExternalControlTest, DoesNotAdoptAProgramInTheMiddleOfAMotion)
{
  auto robot_side = options();
  robot_side.watchdog_frequency = 0.0;
  start(robot_side);
  play();
  ASSERT_TRUE(becomes_ready());
  controller.control({{"command", "remote_control"}, {"on", false}});
  ASSERT_TRUE(eventually([&] { return robot->dashboard()->isInRemoteControl() == false; }, 3s));
  move_joints();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] {
    return robot->status().message.find("before the driver was connected") != std::string::npos;
  })) << robot->status().message;
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(waits_for_play());
  play();
  ASSERT_TRUE(becomes_ready());
  EXPECT_TRUE(keeps_still());
}

TEST_F(ExternalControlTest, RejectsScriptsThatWouldReplaceTheProgram)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  const auto report = run_script("textmsg(\"no\")");
  EXPECT_EQ(report.end, ScriptEnd::rejected);
  EXPECT_EQ(report.error.code, ErrorCode::not_supported);
  EXPECT_NE(report.error.message.find("control_urcap"), std::string::npos) << report.error.message;
  EXPECT_TRUE(works()) << "nothing has happened";
  ScriptOptions beside;
  beside.kind = ScriptKind::secondary;
  beside.timeout = 5s;
  EXPECT_TRUE(run_script("sec f():\n  textmsg(\"yes\")\nend\n", beside));
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(ExternalControlTest, StopsTheProgramWhenTheDriverEnds)
{
  start(options());
  play();
  ASSERT_TRUE(becomes_ready());
  move_joints();
  robot.reset();
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  EXPECT_TRUE(eventually([&] { return controller.state().at("at_rest") == true; }));
}

TEST_F(ExternalControlTest, ReportsThatItsPortIsInUse)
{
  controller.start();
  ScriptServer other(port, 50ms, {[] { return std::nullopt; }, [](const auto &) { return ""; }}, {});
  other.start();
  ASSERT_TRUE(eventually([&] { return other.status().has_value(); }));
  make_robot(options());
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  ASSERT_TRUE(eventually([&] { return robot->status().message.find("in use") != std::string::npos; }))
      << robot->status().message;
  EXPECT_NE(robot->status().message.find("urcap_port"), std::string::npos);
  EXPECT_NE(robot->status().message.find(std::to_string(port)), std::string::npos);
  EXPECT_EQ(log.count("in use"), 1U) << log.text();
  other.stop();
  EXPECT_TRUE(waits_for_play());
}

}  // namespace
}  // namespace ur_ros_rtde::test
