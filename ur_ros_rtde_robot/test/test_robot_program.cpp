#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using RobotProgramTest = RobotFixture;

TEST_F(RobotProgramTest, RetriesAFailedStartAtTheRetryInterval)
{
  auto controller_options = Controller::options();
  // A control cycle lasts 40 ms, so that the program ends before it answers the driver.
  controller_options.real_time_factor = 0.05;
  controller.start(controller_options);
  auto options = robot_options();
  options.retry_interval = 1000ms;
  make_robot(options);
  const std::jthread killer([this](const std::stop_token & stop) {
    while (!stop.stop_requested()) {
      const auto sample = robot->latest();  // the driver has to see the program first
      if (sample && sample->is_program_running() &&
          controller.state().at("program").at("state") == "PLAYING") {
        controller.control({{"command", "kill_program"}});
      }
      std::this_thread::sleep_for(1ms);
    }
  });
  const auto starts = [&] {
    const std::lock_guard lock(mutex);
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < statuses.size(); ++i) {
      if (statuses[i].message == "starting the control program") {
        indices.push_back(i);
      }
    }
    return indices;
  };
  ASSERT_TRUE(eventually([&] { return starts().size() >= 3; }, 30s)) << log.text();
  EXPECT_EQ(log.count("the control program cannot be started"), 1U) << log.text();
  const auto begins = starts();
  const std::lock_guard lock(mutex);
  for (std::size_t i = 1; i < begins.size(); ++i) {
    EXPECT_GT(status_times[begins[i]] - status_times[begins[i] - 1], 500ms);
  }
}

TEST_F(RobotProgramTest, RestartsControlProgramStoppedOnThePendant)
{
  make_both();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_TRUE(robot->control_for_queries()->isSteady());
}

TEST_F(RobotProgramTest, DoesNotStopAProgramThatBeginsBeforeItsOwnIsSent)
{
  make_both();
  auto hold = robot->hold_program();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(comes_to(RobotState::connecting, ErrorCode::not_ready)) << "it is about to start its own";
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); }));
  hold.reset();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped)) << log.text();
  EXPECT_EQ(controller.state().at("program").at("name"), "other");
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
}

TEST_F(RobotProgramTest, DoesNotReplaceAProgramThatBeginsAndIsPausedBeforeItsOwnIsSent)
{
  make_both();
  auto hold = robot->hold_program();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(eventually([&] { return !robot->latest()->is_program_running(); }));
  controller.run_other_program();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->runtime_state == RuntimeState::paused; }));
  hold.reset();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped)) << log.text();
  EXPECT_EQ(controller.state().at("program").at("name"), "other");
  EXPECT_EQ(controller.state().at("program").at("state"), "PAUSED");
}

TEST_F(RobotProgramTest, WarnsThatItsStartHasZeroedTheForceOfAContact)
{
  make_both();
  controller.control({{"command", "push"}, {"force", {0.0, 0.0, 40.0}}, {"duration", 60.0}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->actual_tcp_force[2] > 30.0; }, 90s));
  EXPECT_EQ(log.count("has zeroed the force sensor"), 0U) << log.text();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_EQ(log.count("has zeroed the force sensor"), 1U) << log.text();
  EXPECT_LT(std::abs(robot->latest()->actual_tcp_force[2]), 20.0);
}

TEST_F(RobotProgramTest, NeverTakesItsEndingProgramForAForeignOne)
{
  auto options = Controller::options();
  options.real_time_factor = 0.05;  // the robot's states between running and stopped last for 40 ms
  controller.start(options);
  make_robot();
  ASSERT_TRUE(becomes_ready());
  for (std::size_t i = 0; i < 5; ++i) {
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(becomes_ready_again(i + 2));
  }
  EXPECT_EQ(log.count("another program"), 0U) << log.text();
}

TEST_F(RobotProgramTest, IsStartedBesideQueries)
{
  make_both();
  std::atomic<int> answers{0};
  const std::jthread asking([&](const std::stop_token & stop) {
    while (!stop.stop_requested()) {
      try {
        answers += robot->control_for_queries()->getTCPOffset().size() == 6 ? 1 : 0;
      } catch (const std::exception &) {
        std::this_thread::sleep_for(1ms);  // the program does not run
      }
    }
  });
  for (std::size_t i = 0; i < 5; ++i) {
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(becomes_ready_again(i + 2)) << log.text();
    const int before = answers;
    ASSERT_TRUE(eventually([&] { return answers > before; }));
  }
  EXPECT_EQ(log.count("does not answer"), 0U) << log.text();
}

TEST_F(RobotProgramTest, TakesProgramThatRunsAfterAFailedStartForItsOwn)
{
  make_both();
  for (int i = 0; i < 5; ++i) {
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(eventually([&] { return controller.state().at("program").at("state") != "PLAYING"; }));
    ASSERT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "PLAYING"; }))
        << log.text();
    // It has been uploaded and its first commands are lost, so that the start fails nearly always.
    controller.control(
        {{"command", "lose_commands"}, {"which", "rtde"}, {"clients", "control"}, {"count", 100000}});
    ASSERT_TRUE(eventually([&] { return robot->status().state != RobotState::ready; })) << log.text();
    ASSERT_TRUE(becomes_ready()) << log.text();
  }
  EXPECT_EQ(log.count("another program"), 0U) << log.text();
}

TEST_F(RobotProgramTest, LeavesProgramStoppedWhenRestartingIsOff)
{
  auto options = robot_options();
  options.restart_program = false;
  make_both(options);
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  EXPECT_FALSE(eventually([&] { return robot->status().state == RobotState::ready; }, 700ms));
}

TEST_F(RobotProgramTest, StopsProgramThatRunsWhenItConnects)
{
  controller.start();
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "PLAYING"; }));
  make_robot();
  EXPECT_TRUE(becomes_ready());
  EXPECT_EQ(log.count("a program was running on the robot"), 1U) << log.text();
}

TEST_F(RobotProgramTest, LeavesForeignProgramAloneThatStartsLater)
{
  make_both();
  controller.run_other_program();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  EXPECT_NE(robot->status().message.find("another program"), std::string::npos) << robot->status().message;
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotProgramTest, LeavesForeignProgramAloneAfterALostConnection)
{
  make_both();
  controller.run_other_program();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  const auto before = robot->generation().link;
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return robot->generation().link != before; }));
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped)) << robot->status().message;
  EXPECT_FALSE(eventually([&] { return controller.state().at("program").at("state") != "PLAYING"; }, 700ms));
  robot->io()->setStandardDigitalOut(3, true);  // works without the control program
  EXPECT_TRUE(eventually([&] { return (robot->latest()->digital_outputs & 8U) != 0; }));
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotProgramTest, LeavesForeignProgramAloneThatIsPaused)
{
  make_both();
  const auto says = [&](const char * text) {
    return eventually([&] { return robot->status().message.find(text) != std::string::npos; });
  };
  controller.run_other_program();
  ASSERT_TRUE(says("another program runs")) << robot->status().message;
  controller.control({{"command", "pause_program"}});
  EXPECT_TRUE(says("another program is paused")) << robot->status().message;
  EXPECT_FALSE(eventually([&] { return controller.state().at("program").at("state") != "PAUSED"; }, 700ms));
  controller.control({{"command", "stop_program"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotProgramTest, NoticesReplacementOfItsProgramDuringAMotion)
{
  make_both();
  move_joints();
  const double begin = robot->latest()->controller_time;
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  const double noticed = robot->latest()->controller_time - begin;
  RecordProperty("replaced_program_noticed_after_ms", std::to_string(1000.0 * noticed));
  EXPECT_LT(noticed, 0.2);
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::program_stopped);
  EXPECT_NE(robot->status().message.find("another program"), std::string::npos) << robot->status().message;
}

}  // namespace
}  // namespace ur_ros_rtde::test
