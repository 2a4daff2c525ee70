#include <atomic>
#include <cmath>
#include <thread>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

struct StopTest : RobotFixture {
  /// Stops the arm by the stop command, and returns the time until its target is at rest, s of the
  /// controller.
  double stop_and_measure(const StopOptions & options)
  {
    recording = true;
    const double begin = robot->latest()->controller_time;
    const auto report = robot->stop_motion(options);
    const double end = robot->latest()->controller_time;
    const double duration = recorded_rest() - begin;
    recording = false;
    EXPECT_TRUE(report) << report.error().message;
    if (report) {
      EXPECT_EQ(report->means, StopMeans::stop_command);
      // The stop begins after `begin`, and a late host notices the standstill later.
      EXPECT_GT(report->time_to_standstill, 0.6 * duration);
      EXPECT_LE(report->time_to_standstill, end - begin + 0.01);
    }
    return duration;
  }

  /// Starts a joint motion that occupies the control interface, and waits until it is well under way.
  std::jthread move_in_a_blocking_call(const std::vector<double> & q)
  {
    std::jthread blocked([q, control = control()] { control->moveJ(q, 0.5, 1.0); });
    EXPECT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_qd[0]) > 0.4; }));
    return blocked;
  }
};

StopOptions decelerating(double joint, double linear)
{
  StopOptions options;
  options.joint_deceleration = joint;
  options.linear_deceleration = linear;
  return options;
}

TEST_F(StopTest, DoesNothingWhenArmIsAtRest)
{
  make_both();
  ASSERT_TRUE(eventually([&] { return at_rest(); })) << "detecting standstill takes some cycles";
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->means, StopMeans::nothing_moved);
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(StopTest, DeceleratesAJointMotionAsRequested)
{
  make_both_slow();
  move_joints();
  const double duration = stop_and_measure(decelerating(2.0, 1.0));
  EXPECT_TRUE(at_rest());
  EXPECT_NEAR(highest_deceleration(0), 2.0, 0.3);
  EXPECT_NEAR(duration, 0.4, 0.12) << "0.8 rad/s at 2 rad/s^2, and the cycles for the command";
  EXPECT_TRUE(robot->ready_to_move()) << "the program goes on";
}

TEST_F(StopTest, DeceleratesALinearMotionAlongItsLine)
{
  make_both_slow();
  const auto start = robot->latest()->actual_tcp_pose;
  move_linear();
  EXPECT_NEAR(stop_and_measure(decelerating(1.0, 0.5)), 0.2, 0.12);
  const auto end = robot->latest()->actual_tcp_pose;
  EXPECT_NEAR(end[0], start[0], 1e-3);
  EXPECT_NEAR(end[1], start[1], 1e-3);
}

TEST_F(StopTest, EndsSpeedJ)
{
  make_both_slow();
  ASSERT_TRUE(control()->speedJ({0.4, 0.0, 0.0, 0.0, 0.0, 0.0}, 2.0, 0.0));
  ASSERT_TRUE(eventually([&] { return robot->latest()->actual_qd[0] > 0.35; }));
  recording = true;
  const auto report = robot->stop_motion(decelerating(1.0, 1.0));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_NEAR(highest_deceleration(0), 1.0, 0.2);
  EXPECT_TRUE(at_rest());
}

TEST_F(StopTest, EndsSpeedL)
{
  make_both_slow();
  ASSERT_TRUE(control()->speedL({0.0, 0.0, 0.05, 0.0, 0.0, 0.0}, 0.5, 0.0));
  ASSERT_TRUE(eventually([&] { return robot->latest()->actual_tcp_speed[2] > 0.04; }));
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_TRUE(at_rest());
}

TEST_F(StopTest, EndsServoJ)
{
  make_both_slow();
  auto q = robot->receive()->getActualQ();
  Sample sample = *robot->latest();
  for (int i = 0; i < 200; ++i) {
    q[5] += 0.001;
    ASSERT_TRUE(control()->servoJ(q, 0.0, 0.0, 0.002, 0.05, 300.0)) << log.text();
    ASSERT_TRUE(robot->wait_for_next(sample, 1s));
  }
  EXPECT_TRUE(robot->is_moving());
  recording = true;
  const auto report = robot->stop_motion(decelerating(1.0, 40.0));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_NEAR(highest_deceleration(5), 1.0, 0.2) << "the joint turns the tool in place";
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(StopTest, LeavesTheRobotReadyForTheNextMotion)
{
  make_both_slow();
  for (int i = 0; i < 3; ++i) {
    move_linear();
    ASSERT_TRUE(robot->stop_motion(decelerating(4.0, 2.0)));
    auto pose = robot->receive()->getActualTCPPose();
    pose[2] -= 0.02;
    ASSERT_TRUE(control()->moveL(pose, 0.2, 1.0)) << "motion " << i << "\n" << log.text();
  }
}

TEST_F(StopTest, StopsAMotionThatWasJustCommanded)
{
  make_both_slow();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  ASSERT_TRUE(control()->moveJ(q, 0.5, 1.0, true));
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  const auto sequence = robot->latest()->sequence;
  ASSERT_TRUE(eventually([&] { return robot->latest()->sequence > sequence + 100; }));
  EXPECT_TRUE(at_rest()) << "the motion began after the stop";
}

TEST_F(StopTest, StopsTheProgramDuringABlockingMotion)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  const auto blocked = move_in_a_blocking_call(q);
  ASSERT_FALSE(HasFailure());
  auto options = decelerating(2.0, 2.0);
  options.timeout = 500ms;
  const auto report = robot->stop_motion(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::program_stopped);
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(becomes_ready());
}

TEST_F(StopTest, GoesOnToTheNextMeansWhileItIsRequestedAgainAndAgain)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  const auto blocked = move_in_a_blocking_call(q);
  ASSERT_FALSE(HasFailure());
  std::jthread insisting([&](const std::stop_token & stop) {
    while (!stop.stop_requested()) {
      robot->begin_stop({}, Error{ErrorCode::preempted, "stopped"});
      std::this_thread::sleep_for(2ms);
    }
  });
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_TRUE(robot->stop_motion()) << "every request gets its report";
  EXPECT_GT(std::abs(robot->latest()->actual_q[0] - q[0]), 1.5) << "the motion went on";
}

TEST_F(StopTest, MayBeRequestedBySeveralThreads)
{
  make_both_slow();
  move_joints();
  std::atomic<int> stopped{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] { stopped += robot->stop_motion() ? 1 : 0; });
    }
  }
  EXPECT_EQ(stopped, 4);
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(StopTest, UsesTheDashboardServerWithoutRtde)
{
  auto options = robot_options();
  options.watchdog_frequency = 0.0;  // only the stop ends the motion
  make_both(options);
  move_joints();
  controller.control({{"command", "refuse_connections"}, {"which", "rtde"}});  // standstill is not seen
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  const auto stopped = robot->stop_motion();
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::link_lost);
  EXPECT_NE(stopped.error().message.find("was stopped through the dashboard server"), std::string::npos)
      << stopped.error().message;
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
  EXPECT_TRUE(eventually([&] { return controller.state().at("at_rest").get<bool>(); }));
}

TEST_F(StopTest, NamesTheWatchdogThatRuns)
{
  struct Case {
    double of_options, set;  // Hz; set: 0 for none
    const char * end;
  };
  for (const Case & given : {Case{0.0, 0.0, "no watchdog (watchdog_frequency: 0): use the emergency stop"},
                             Case{4.0, 0.0, "the watchdog of its program stops the arm within 0.25 s"},
                             Case{10.0, 2.0, "the watchdog of its program stops the arm within 0.5 s"}}) {
    controller.start();
    auto options = robot_options();
    options.watchdog_frequency = given.of_options;
    make_robot(options);
    ASSERT_TRUE(becomes_ready());
    ASSERT_TRUE(given.set == 0.0 || robot->set_watchdog(given.set));
    controller.stop();
    ASSERT_TRUE(comes_to(RobotState::disconnected, ErrorCode::link_lost));
    const auto stopped = robot->stop_motion();
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::link_lost);
    EXPECT_NE(stopped.error().message.find(given.end), std::string::npos) << stopped.error().message;
    robot.reset();
  }
}

TEST_F(StopTest, IsPartOfTheDriversShutdown)
{
  make_both();
  move_joints();
  robot.reset();
  const auto state = controller.state();
  for (const auto & velocity : state.at("actual").at("velocity")) {
    EXPECT_LT(std::abs(velocity.get<double>()), 0.01);
  }
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }));
}

}  // namespace
}  // namespace ur_ros_rtde::test
