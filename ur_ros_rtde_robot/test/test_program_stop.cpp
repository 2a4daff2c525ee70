// Stops that have to end a program: the control program, a script, or one that is not of this driver.
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

struct ProgramStopTest : RobotFixture {
  /// In local control, the dashboard server does not end the program.
  void make_both_in_local_control(double watchdog_frequency)
  {
    auto options = robot_options();
    options.watchdog_frequency = watchdog_frequency;
    make_both(options);
    controller.control({{"command", "remote_control"}, {"on", false}});
  }
  void start_force_mode()
  {
    ASSERT_TRUE(control()->forceMode({0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, 2,
                                     {0.1, 0.1, 0.1, 0.5, 0.5, 0.5}));
  }
};

StopOptions decelerating(double joint, double linear)
{
  StopOptions options;
  options.joint_deceleration = joint;
  options.linear_deceleration = linear;
  return options;
}

/// The robot has paused it, and resumes it when the safeguard closes.
TEST_F(ProgramStopTest, DoesNotSucceedIfAPausedProgramCannotBeEnded)
{
  auto options = robot_options();
  options.watchdog_frequency = 0.0;
  make_both(options);
  move_joints();
  controller.control({{"command", "remote_control"}, {"on", false}});
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  const auto report = robot->stop_motion();
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("stop it on the pendant"), std::string::npos)
      << report.error().message;
  const auto link = robot->latest()->link;
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->link != link; }));
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  const auto again = robot->stop_motion();
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("stop it on the pendant"), std::string::npos) << again.error().message;
}

TEST_F(ProgramStopTest, EndsAForeignProgramThatStandsIfAsked)
{
  make_both();
  const std::string swinging =
      "def swing():\n"
      "  q = get_actual_joint_positions()\n"
      "  while True:\n"
      "    q[0] = q[0] + 0.2\n"
      "    movej(q, a=10, v=2)\n"
      "    sleep(0.5)\n"
      "  end\n"
      "end\n";
  const auto before = robot->generation();
  controller.control({{"command", "run_script"}, {"script", swinging}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  ASSERT_TRUE(eventually([&] { return !at_rest(); }) && eventually([&] { return at_rest(); }));
  EXPECT_TRUE(robot->stop_motion()) << "the end of a goal or of the driver leaves it alone";
  EXPECT_TRUE(eventually([&] { return !at_rest(); }) && eventually([&] { return at_rest(); }));
  StopOptions options;
  options.ends_foreign_program = true;
  const auto report = robot->stop_motion(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::program_stopped);
  EXPECT_TRUE(becomes_ready());
  EXPECT_FALSE(robot->is_continued(before)) << "a goal that has waited since does not begin";
}

/// Without a control program, with RTDE connections that can stay silent for `silence_limit`.
struct LateSamplesTest : ProgramStopTest {
  using Stopping = std::shared_future<Expected<StopReport>>;

  void start(std::chrono::milliseconds silence_limit = 5000ms)
  {
    auto options = robot_options();
    options.silence_limit = silence_limit;
    options.watchdog_frequency = 0.0;
    options.restart_program = false;
    make_both(options);
    controller.control({{"command", "stop_program"}});
    ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  }
  void stall(bool on)
  {
    controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"stalled", on}});
  }
  void wait_until_late()
  {
    ASSERT_TRUE(
        eventually([&] { return std::chrono::steady_clock::now() - robot->latest()->received > 300ms; }));
    ASSERT_FALSE(robot->latest()->is_program_running());
  }
  Stopping begin_stop()
  {
    StopOptions options;
    options.ends_foreign_program = true;
    return robot->begin_stop(options, stopped_by_the_driver());
  }
  std::string program() { return controller.state().at("program").at("state"); }
};

TEST_F(LateSamplesTest, DoNotKeepAStopFromEndingAForeignProgram)
{
  start();
  stall(true);
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return program() == "PLAYING"; }));
  wait_until_late();
  const auto link = robot->latest()->link;
  const auto stopping = begin_stop();
  EXPECT_TRUE(eventually([&] { return program() == "STOPPED"; }));
  EXPECT_EQ(robot->latest()->link, link) << "the end of the connection has ended the program";
  stall(false);
  EXPECT_TRUE(stopping.get());
}

TEST_F(LateSamplesTest, AreNoProofOfAForeignProgram)
{
  start();
  controller.control({{"command", "remote_control"}, {"on", false}});  // the robot rejects `stop`
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  stall(true);
  wait_until_late();
  const auto stopping = begin_stop();
  EXPECT_EQ(stopping.wait_for(300ms), std::future_status::timeout) << "the samples do not show the present";
  stall(false);
  const auto report = stopping.get();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::nothing_moved);
}

TEST_F(LateSamplesTest, DoNotEndAPausedProgram)
{
  start();
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return robot->latest()->is_program_running(); }));
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->runtime_state == RuntimeState::paused; }));
  stall(true);
  wait_until_late();
  const auto stopping = begin_stop();
  EXPECT_EQ(stopping.wait_for(300ms), std::future_status::timeout) << "the samples do not show the present";
  stall(false);
  EXPECT_TRUE(stopping.get());
  EXPECT_EQ(program(), "PAUSED");
}

TEST_F(LateSamplesTest, OfAConnectionThatIsLostAreNotSaidToShowAProgram)
{
  start(1500ms);
  stall(true);
  controller.run_other_program();
  ASSERT_TRUE(eventually([&] { return program() == "PLAYING"; }));
  wait_until_late();
  const auto report = begin_stop().get();  // it is repeated if the robot is connected again by then
  EXPECT_TRUE(report || report.error().code == ErrorCode::link_lost) << report.error().message;
  EXPECT_EQ(program(), "STOPPED");
}

/// The receiving thread is late, and reads what has queued up when the program has been stopped.
TEST_F(LateSamplesTest, AreNoProofOfAStandstill)
{
  std::atomic<bool> is_to_wait{false};
  std::atomic<bool> waits{false};
  on_sample = [&](const Sample &) {
    while (is_to_wait) {
      waits = true;
      is_to_wait.wait(true);
    }
  };
  start();
  is_to_wait = true;
  EXPECT_TRUE(eventually([&] { return waits.load(); }));
  controller.control(
      {{"command", "run_script"}, {"script", "def turn():\n  speedj([1.5, 0, 0, 0, 0, 0], 20, 10)\nend\n"}});
  const auto speed = [&] {
    return std::abs(controller.state().at("actual").at("velocity").at(0).get<double>());
  };
  EXPECT_TRUE(eventually([&] { return speed() > 1.4; }));
  wait_until_late();
  const auto stopping = begin_stop();
  EXPECT_TRUE(eventually([&] { return program() == "STOPPED"; }));
  is_to_wait = false;
  is_to_wait.notify_all();
  const auto report = stopping.get();
  const double then = speed();
  EXPECT_TRUE(report) << report.error().message;
  EXPECT_LT(then, 0.02);
  robot.reset();  // its thread uses the variables of this test
}

TEST_F(ProgramStopTest, SaysThatItCannotEndAForeignProgramInLocalControl)
{
  make_both();
  controller.run_other_program();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  controller.control({{"command", "remote_control"}, {"on", false}});
  StopOptions options;
  options.ends_foreign_program = true;
  const double begin = robot->latest()->controller_time;
  const auto report = robot->stop_motion(options);
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("is not of this driver"), std::string::npos)
      << report.error().message;
  EXPECT_LT(robot->latest()->controller_time - begin, 1.0) << "it waits for no watchdog";
  controller.control({{"command", "remote_control"}, {"on", true}});
}

TEST_F(ProgramStopTest, LeavesAForeignProgramAloneThatIsPaused)
{
  make_both();
  controller.run_other_program();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->runtime_state == RuntimeState::paused; }));
  StopOptions options;
  options.ends_foreign_program = true;
  EXPECT_TRUE(robot->stop_motion(options));
  EXPECT_EQ(controller.state().at("program").at("state"), "PAUSED");
}

TEST_F(ProgramStopTest, SucceedsByTheWatchdogOnlyAtTheEndOfTheProgram)
{
  auto options = robot_options();
  options.watchdog_frequency = 2.0;
  make_both(options);
  const std::string dwelling =
      "def dwell():\n"
      "  q = get_actual_joint_positions()\n"
      "  q[0] = q[0] + 0.2\n"
      "  movej(q, a=10, v=2)\n"
      "  sleep(1)\n"
      "  q[0] = q[0] + 1\n"
      "  movej(q, a=2, v=0.8)\n"
      "end\n";
  const double start = robot->latest()->actual_q[0];
  std::jthread script([&] { run_script(dwelling); });
  ASSERT_TRUE(eventually([&] { return robot->latest()->actual_q[0] > start + 0.19 && at_rest(); }));
  controller.control({{"command", "remote_control"}, {"on", false}});
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::watchdog);
  EXPECT_FALSE(robot->latest()->is_program_running());
  const double end = robot->latest()->controller_time + 0.5;
  EXPECT_TRUE(eventually([&] { return robot->latest()->controller_time > end; }));
  EXPECT_NEAR(robot->latest()->actual_q[0], start + 0.2, 0.02) << "the script went on";
}

TEST_F(ProgramStopTest, DoesNotForgetAProgramWhoseConnectionItHasClosed)
{
  make_both_in_local_control(1.0);
  start_force_mode();
  ASSERT_FALSE(HasFailure());
  ASSERT_TRUE(control()->speedL({0.05, 0.0, 0.0, 0.0, 0.0, 0.0}, 1.0, 0.0));
  ASSERT_TRUE(eventually([&] { return robot->latest()->target_tcp_speed[0] > 0.049; }));
  const std::jthread blocked([control = control()] { control->speedStop(0.25); });
  ASSERT_TRUE(eventually([&] { return robot->latest()->target_tcp_speed[0] < 0.045; }));
  robot->begin_stop(decelerating(1.0, 1.0), stopped_by_the_driver());
  ASSERT_TRUE(eventually([&] { return at_rest(); }));  // but force mode is on
  ASSERT_FALSE(robot->ready_to_move());
  const auto report = robot->stop_motion(decelerating(2.0, 2.0));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::watchdog);
  EXPECT_EQ(robot->latest()->runtime_state, RuntimeState::stopped);
}

TEST_F(ProgramStopTest, DoesNotForgetAProgramThatCouldNotBeEndedForAScript)
{
  make_both_in_local_control(0.0);
  ASSERT_TRUE(control()->startContactDetection());  // a contact moves the arm
  {
    const auto call = robot->control_for_queries().hold();  // nothing can end the program
    EXPECT_EQ(run_script("def s():\n  sync()\nend\n").end, ScriptEnd::rejected);
  }
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  ASSERT_TRUE(robot->latest()->is_program_running());
  const auto report = robot->stop_motion();
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("may move the arm again: stop it on the pendant"), std::string::npos)
      << report.error().message;
}

}  // namespace
}  // namespace ur_ros_rtde::test
