#include <cstdlib>
#include <fstream>
#include <thread>
#include <utility>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;
using RobotConnectionTest = RobotFixture;

double seconds_since(Clock::time_point begin)
{
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

TEST_F(RobotConnectionTest, BecomesReady)
{
  controller.start();
  const auto begin = Clock::now();
  make_robot();
  ASSERT_TRUE(becomes_ready());
  RecordProperty("ready_after_s", std::to_string(seconds_since(begin)));
  EXPECT_TRUE(robot->ready_to_move());
  EXPECT_TRUE(robot->control_for_queries()->isProgramRunning());
  EXPECT_TRUE(robot->io()->setStandardDigitalOut(1, true));
  EXPECT_TRUE(eventually([&] { return (robot->latest()->digital_outputs & 2U) != 0; }));
  EXPECT_NE(robot->dashboard()->robotmode().find("RUNNING"), std::string::npos);
}

TEST_F(RobotConnectionTest, AffectsTheRobotOnlyAfterTheStart)
{
  controller.start();
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "PLAYING"; }));
  robot = std::make_unique<Robot>(robot_options(), log.function());
  robot->connect();
  ASSERT_TRUE(eventually([&] { return log.count("is a ur10e") == 1; })) << log.text();
  EXPECT_TRUE(robot->latest());
  EXPECT_FALSE(eventually([&] { return robot->status().state != RobotState::disconnected; }, 500ms));
  EXPECT_EQ(controller.state().at("program").at("state"), "PLAYING");
  EXPECT_THROW(robot->io(), RobotError);
  robot->start();
  EXPECT_TRUE(becomes_ready());
  EXPECT_EQ(log.count("is a ur10e"), 1U) << log.text();
}

TEST_F(RobotConnectionTest, ReportsThatPolyScopeXIsNotSupported)
{
  auto options = Controller::options();
  options.polyscope_version = "10.12.0";
  options.ports.robot_api = 0;
  controller.start(options);
  make_robot();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_supported));
  EXPECT_NE(robot->status().message.find("PolyScope 10.12.0: PolyScope X has no dashboard server"),
            std::string::npos)
      << robot->status().message;
  EXPECT_TRUE(robot->latest());
  EXPECT_TRUE(robot->link().connected);
  const auto answer = robot->query_dashboard("robotmode", 500ms);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().message, robot->status().message);
}

TEST_F(RobotConnectionTest, BecomesReadyOnEarlyVersionsOfPolyscope5)
{
  for (const char * version : {"5.0.0", "5.3.0", "5.9.0"}) {
    auto options = Controller::options();
    options.polyscope_version = version;
    controller.start(options);
    make_robot();
    EXPECT_TRUE(becomes_ready()) << version;
    EXPECT_TRUE(robot->control_for_queries()->isSteady()) << version;
    robot.reset();
    controller.stop();
  }
}

TEST_F(RobotConnectionTest, WaitsForControllerThatStartsLater)
{
  make_robot();
  ASSERT_TRUE(eventually([&] { return log.count("Trying again") > 0; }));
  EXPECT_EQ(robot->status().state, RobotState::disconnected);
  EXPECT_EQ(robot->status().cause, ErrorCode::link_lost);
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  EXPECT_FALSE(robot->ready_to_move());
  controller.start();
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotConnectionTest, FollowsPowerUpOfTheArm)
{
  auto options = Controller::options();
  options.start_running = false;
  controller.start(options);
  make_robot();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  EXPECT_NE(robot->status().message.find("dashboard/power_on"), std::string::npos) << robot->status().message;
  EXPECT_TRUE(robot->io()->setStandardDigitalOut(0, true)) << "IO works without power at the arm";
  controller.control({{"command", "power"}, {"to", "on"}});
  ASSERT_TRUE(eventually(
      [&] { return robot->status().message.find("dashboard/brake_release") != std::string::npos; }, 20s));
  controller.control({{"command", "power"}, {"to", "running"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotConnectionTest, ReportsLocalControlAndBecomesReadyInRemoteControl)
{
  auto options = Controller::options();
  options.remote_control = false;
  controller.start(options);
  make_robot();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  EXPECT_NE(robot->status().message.find("remote control"), std::string::npos);
  EXPECT_EQ(log.count("local control"), 1U) << log.text();
  controller.control({{"command", "remote_control"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotConnectionTest, ReportsEachStatusChangeOnce)
{
  make_both();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  const std::lock_guard lock(mutex);
  ASSERT_GE(statuses.size(), 3U);
  for (std::size_t i = 1; i < statuses.size(); ++i) {
    EXPECT_FALSE(statuses[i].state == statuses[i - 1].state &&
                 statuses[i].message == statuses[i - 1].message);
  }
  EXPECT_EQ(statuses.back().cause, ErrorCode::protective_stop);
}

TEST_F(RobotConnectionTest, BecomesReadyAfterARebootOnceTheArmIsPowered)
{
  make_both();
  controller.control({{"command", "reboot"}, {"duration", 0.3}});
  ASSERT_TRUE(comes_to(RobotState::disconnected, ErrorCode::link_lost));
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  controller.control({{"command", "power"}, {"to", "running"}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotConnectionTest, BecomesReadyAfterDroppedLinks)
{
  make_both();
  std::size_t times = 1;
  for (const bool reset : {false, true}) {
    controller.control({{"command", "drop_links"}, {"reset", reset}});
    const auto begin = Clock::now();
    ASSERT_TRUE(becomes_ready_again(++times));
    RecordProperty("ready_again_after_s", std::to_string(seconds_since(begin)));
  }
}

TEST_F(RobotConnectionTest, IsReadyWhileSamplesAreLateOnANewConnection)
{
  auto options = robot_options();
  options.silence_limit = 2000ms;
  options.watchdog_frequency = 0.0;
  on_sample = [link = std::uint32_t{0}](const Sample & sample) mutable {
    if (std::exchange(link, sample.link) != sample.link) {
      std::this_thread::sleep_for(100ms);  // a late thread: others see the sample before the connection
    }
  };
  make_both(options);
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(becomes_ready_again());
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  const auto late = 2 * options.retry_interval;  // the robot is examined at least once
  ASSERT_TRUE(eventually([&] { return Clock::now() - robot->latest()->received > late; }));
  EXPECT_EQ(robot->status().state, RobotState::ready) << robot->status().message;
}

TEST_F(RobotConnectionTest, NoticesThatOnlyTheControlLinkWasDropped)
{
  make_both();
  const auto before = robot->generation();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "control"}});
  EXPECT_TRUE(becomes_ready_again());
  const Status current = robot->is_current(before);
  ASSERT_FALSE(current);
  EXPECT_EQ(current.error().code, ErrorCode::link_lost)
      << "the driver has ended the program: " << current.error().message;
}

TEST_F(RobotConnectionTest, ReconnectsIoAfterOnlyItsLinkWasDropped)
{
  make_both();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}, {"clients", "io"}});
  EXPECT_TRUE(eventually([&] {
    robot->io()->setStandardDigitalOut(3, true);
    return (robot->latest()->digital_outputs & 8U) != 0;
  })) << log.text();
}

TEST_F(RobotConnectionTest, SurvivesControllerThatNeverReturns)
{
  make_both();
  controller.stop();
  ASSERT_TRUE(comes_to(RobotState::disconnected, ErrorCode::link_lost));
  EXPECT_THROW(robot->control_for_queries(), RobotError);
  EXPECT_THROW(robot->io(), RobotError);
  EXPECT_FALSE(robot->stop_motion());
  controller.start();
  EXPECT_TRUE(becomes_ready());
}

/// Resident memory in kB.
std::size_t resident_memory()
{
  std::ifstream file("/proc/self/statm");
  std::size_t whole = 0;
  std::size_t resident = 0;
  file >> whole >> resident;
  return resident * 4;
}

/// UR_RECONNECTIONS=1000 for the long run.
unsigned reconnections()
{
  const char * wanted = std::getenv("UR_RECONNECTIONS");
  return wanted != nullptr ? static_cast<unsigned>(std::stoul(wanted)) : 40U;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool keeps_freed_memory = true;  // the sanitizer does
#else
constexpr bool keeps_freed_memory = false;
#endif

TEST_F(RobotConnectionTest, LeaksNothingOverManyReconnections)
{
  controller.start();
  auto options = robot_options();
  options.retry_interval = 10ms;
  make_robot(options);
  const auto all_is_well = [this] {
    try {
      return robot->ready_to_move() && robot->io()->isConnected() && !robot->dashboard()->robotmode().empty();
    } catch (const std::exception &) {
      return false;
    }
  };
  std::size_t descriptors = 0;
  std::size_t threads = 0;
  std::size_t memory = 0;
  for (unsigned round = 0; round < reconnections(); ++round) {
    ASSERT_TRUE(eventually([&] { return all_is_well() && robot->latest()->link > round; }, 20s))
        << log.text();
    if (round == 5) {
      descriptors = open_descriptors();
      threads = running_threads();
    }
    if (round == 20) {
      memory = resident_memory();
    }
    if (round > 5) {
      EXPECT_TRUE(eventually([&] { return open_descriptors() <= descriptors + 3; }))
          << "round " << round << ": " << open_descriptors() << " of " << descriptors;
      EXPECT_TRUE(eventually([&] { return running_threads() <= threads; }))
          << "round " << round << ": " << running_threads() << " of " << threads;
    }
    // A lost dashboard link is noticed by its heartbeat, once a second.
    controller.control({{"command", "drop_links"}, {"which", round % 10 == 0 ? "all" : "rtde"}});
  }
  const auto grown = static_cast<double>(resident_memory()) - static_cast<double>(memory);
  RecordProperty("grown_by_kB", std::to_string(grown));
  if (!keeps_freed_memory) {
    // Includes the test's log.
    EXPECT_LT(grown, 4000.0 + 2.0 * reconnections()) << "kB";
  }
}

TEST_F(RobotConnectionTest, EndsAtAnyMomentOfItsStart)
{
  controller.start();
  for (const auto delay : {0ms, 5ms, 20ms, 60ms, 150ms}) {
    make_robot();
    eventually([] { return false; }, delay);
    const auto begin = Clock::now();
    robot.reset();
    EXPECT_LT(seconds_since(begin), 8.0);
  }
}

TEST_F(RobotConnectionTest, RejectsOptionsOutOfRange)
{
  auto options = robot_options();
  options.watchdog_frequency = 0.5;
  EXPECT_THROW(Robot{options}, std::invalid_argument);
  options.watchdog_frequency = 10.0;
  options.frequency = 1000.0;
  EXPECT_THROW(Robot{options}, std::invalid_argument);
  make_robot();
  const auto set = robot->set_watchdog(60.0);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, ErrorCode::invalid_goal);
  EXPECT_NE(set.error().message.find("from 1 to 50 Hz"), std::string::npos);
}

}  // namespace
}  // namespace ur_ros_rtde::test
