#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <thread>

#include "robot_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

using Clock = std::chrono::steady_clock;
using RobotMotionTest = RobotFixture;

TEST_F(RobotMotionTest, IsTrackedFromStartToEnd)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  q[5] += 0.3;
  const auto mark = robot->mark_motion();
  EXPECT_FALSE(robot->motion_progress(mark).started);
  ASSERT_TRUE(control()->moveJ(q, 1.0, 3.0, true));
  ASSERT_TRUE(eventually([&] { return robot->motion_progress(mark).running; }));
  EXPECT_FALSE(robot->motion_progress(mark).finished());
  ASSERT_TRUE(eventually([&] { return robot->motion_progress(mark).finished(); }, 10s));
  EXPECT_NEAR(robot->latest()->actual_q[5], q[5], 1e-3);
  EXPECT_FALSE(robot->is_moving());
}

TEST_F(RobotMotionTest, IsNotFinishedByTheEndOfThePreviousOne)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  for (int i = 0; i < 5; ++i) {
    q[5] += i % 2 == 0 ? 0.1 : -0.1;
    const auto mark = robot->mark_motion();
    ASSERT_FALSE(robot->motion_progress(mark).finished());
    ASSERT_TRUE(control()->moveJ(q, 1.0, 5.0, true));
    ASSERT_TRUE(eventually([&] { return robot->motion_progress(mark).finished(); }, 10s));
    EXPECT_NEAR(robot->latest()->actual_q[5], q[5], 1e-3) << "motion " << i;
  }
}

bool stands(const Sample & sample)
{
  const auto all = [](const Vector6 & values, double limit) {
    return std::all_of(values.begin(), values.end(), [limit](double v) { return std::abs(v) < limit; });
  };
  return all(sample.target_qd, 1e-12) && all(sample.actual_qd, StandstillDetector::velocity);
}

/// Evaluates each package when it arrives, so that a late host changes nothing.
struct RobotArrivalTest : RobotFixture, testing::WithParamInterface<double> {
  std::optional<MotionMark> mark;
  std::size_t packages_at_rest = 0;   ///< until the motion was reported as finished
  std::vector<Sample> after_the_end;  ///< from that package on

  ~RobotArrivalTest() override { robot.reset(); }  // no packages arrive while the members are destroyed

  void add(const Sample & sample)
  {
    const std::lock_guard lock(mutex);
    if (after_the_end.empty()) {
      packages_at_rest = stands(sample) ? packages_at_rest + 1 : 0;
    }
    if (mark && (!after_the_end.empty() || robot->motion_progress(*mark).finished())) {
      after_the_end.push_back(sample);
    }
  }
};

TEST_P(RobotArrivalTest, IsReportedAtOnceAndNeverEarly)
{
  controller.start();
  robot = std::make_unique<Robot>(robot_options(), log.function());
  robot->on_sample([this](const Sample & sample) { add(sample); });
  robot->start();
  ASSERT_TRUE(becomes_ready());
  auto q = robot->receive()->getActualQ();
  q[5] += 0.5;
  q[0] -= 0.3;
  {
    const std::lock_guard lock(mutex);
    mark = robot->mark_motion();
  }
  ASSERT_TRUE(control()->moveJ(q, 1.0, GetParam(), true));
  const auto seen = [this] {
    const std::lock_guard lock(mutex);
    return after_the_end.size() > 100;
  };
  ASSERT_TRUE(eventually(seen, 10s));
  const std::lock_guard lock(mutex);
  EXPECT_LE(packages_at_rest, 3U)
      << "the control program reports its end one package after the target stands";
  for (const Sample & sample : after_the_end) {
    ASSERT_TRUE(stands(sample));
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_NEAR(sample.actual_q[i], q[i], 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Accelerations, RobotArrivalTest, testing::Values(1.4, 3.0, 15.0));

TEST_F(RobotMotionTest, ToTheCurrentPositionEnds)
{
  make_both();
  const auto q = robot->receive()->getActualQ();
  const auto mark = robot->mark_motion();
  ASSERT_TRUE(control()->moveJ(q, 1.0, 3.0, true));
  EXPECT_TRUE(eventually([&] { return robot->motion_progress(mark).finished(); })) << log.text();
}

TEST_F(RobotMotionTest, EndsWithTheCauseInAProtectiveStop)
{
  make_both();
  move_joints();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::protective_stop);
  const auto stopped = robot->stop_motion();
  ASSERT_TRUE(stopped) << stopped.error().message;
  EXPECT_EQ(stopped->means, StopMeans::stopped_by_robot);
  EXPECT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
}

TEST_F(RobotMotionTest, IsNotResumedAfterAProtectiveStop)
{
  make_both();
  move_joints();
  controller.control({{"command", "protective_stop"}, {"reason", "test"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::protective_stop));
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  const auto q = robot->latest()->actual_q;
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
  ASSERT_TRUE(becomes_ready());
  const auto sequence = robot->latest()->sequence;
  ASSERT_TRUE(eventually([&] { return robot->latest()->sequence > sequence + 200; }));
  EXPECT_NEAR(robot->latest()->actual_q[0], q[0], 1e-3) << "the old motion was resumed";
  move_joints();
}

TEST_F(RobotMotionTest, EndsWithCauseAndRemedyInAnEmergencyStop)
{
  make_both();
  move_joints();
  controller.control({{"command", "emergency_stop"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::emergency_stop);
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::emergency_stop));
  controller.control({{"command", "emergency_stop"}, {"pressed", false}});
  controller.control({{"command", "power"}, {"to", "running"}});
  EXPECT_TRUE(becomes_ready(20s));
}

TEST_F(RobotMotionTest, HasTheCauseOfItsOwnProgramsEndAtEveryMoment)
{
  make_both();
  for (std::size_t ready = 1; ready < 8; ready += 2) {
    ASSERT_TRUE(becomes_ready_again(ready));
    controller.control({{"command", "emergency_stop"}});
    ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::emergency_stop));
    controller.control({{"command", "emergency_stop"}, {"pressed", false}});
    controller.control({{"command", "power"}, {"to", "running"}});
    ASSERT_TRUE(becomes_ready_again(ready + 1)) << log.text();
    auto first = std::async(std::launch::async, [&] {
      const auto deadline = std::chrono::steady_clock::now() + 15s;
      Status possible = robot->motion_possible();
      while (possible && std::chrono::steady_clock::now() < deadline) {
        possible = robot->motion_possible();
      }
      return possible;
    });
    controller.control({{"command", "stop_program"}});
    const Status possible = first.get();
    ASSERT_FALSE(possible);
    EXPECT_EQ(possible.error().code, ErrorCode::program_stopped) << possible.error().message;
  }
}

TEST_F(RobotMotionTest, EndsInASafeguardStopAndIsNotResumed)
{
  make_both();
  move_joints();
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::safeguard_stop));
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  const auto q = robot->latest()->actual_q;
  controller.control({{"command", "safeguard"}, {"open", false}});
  ASSERT_TRUE(becomes_ready());
  EXPECT_NEAR(robot->latest()->actual_q[0], q[0], 1e-3) << "the old motion was resumed";
}

TEST_F(RobotMotionTest, IsNotResumedAfterASafeguardStopInWhichTheConnectionWasLost)
{
  make_both();
  move_joints();
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::safeguard_stop));
  // Before the safeguard is closed. The watchdog would end it after a second.
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }, 700ms));
  const auto q = robot->latest()->actual_q;
  controller.control({{"command", "safeguard"}, {"open", false}});
  ASSERT_TRUE(becomes_ready());
  EXPECT_NEAR(robot->latest()->actual_q[0], q[0], 1e-3);
}

TEST_F(RobotMotionTest, EndsWhenItsProgramIsStoppedOnThePendant)
{
  make_both();
  const auto mark = robot->mark_motion();
  move_joints();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::program_stopped);
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_TRUE(robot->motion_progress(mark).program_ended);
  EXPECT_FALSE(robot->motion_progress(mark).finished()) << "the motion ended before its target";
}

TEST_F(RobotMotionTest, IsNotResumedWithAProgramPausedOnThePendant)
{
  make_both();
  move_joints();
  controller.control({{"command", "pause_program"}});
  ASSERT_TRUE(becomes_ready_again());
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  const auto q = robot->latest()->actual_q;
  const auto sequence = robot->latest()->sequence;
  ASSERT_TRUE(eventually([&] { return robot->latest()->sequence > sequence + 100; }));
  EXPECT_NEAR(robot->latest()->actual_q[0], q[0], 1e-3);
}

TEST_F(RobotMotionTest, EndsWhenTheControllerDies)
{
  make_both();
  move_joints();
  controller.stop();
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::link_lost);
  const auto begin = Clock::now();
  const auto stopped = robot->stop_motion();
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::link_lost);
  EXPECT_LT(Clock::now() - begin, 1s);
}

TEST_F(RobotMotionTest, IsStoppedByTheWatchdogOnAHalfOpenConnection)
{
  auto options = robot_options();
  options.silence_limit = 300ms;
  options.watchdog_frequency = 4.0;
  make_both(options);
  move_joints();
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return !robot->motion_possible(); }));
  EXPECT_EQ(robot->motion_possible().error().code, ErrorCode::link_lost);
  EXPECT_TRUE(eventually([&] { return controller.state().at("program").at("state") == "STOPPED"; }))
      << "the program goes on";
  EXPECT_TRUE(eventually([&] { return controller.state().at("at_rest").get<bool>(); }));
  controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"stalled", false}});
  EXPECT_TRUE(becomes_ready());
}

TEST_F(RobotMotionTest, TheEndOfAProgramThatReceivesNothingNamesItsWatchdog)
{
  auto options = robot_options();
  options.watchdog_frequency = 4.0;
  make_both(options);
  controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"clients", "control"}});
  std::string message;
  EXPECT_TRUE(eventually([&] {
    const Status possible = robot->motion_possible();
    message = possible ? "" : possible.error().message;
    return message.find("watchdog") != std::string::npos;
  })) << message;
}

TEST_F(RobotMotionTest, ACommandOnASilentConnectionIsALostConnection)
{
  auto options = robot_options();
  options.watchdog_frequency = 0.0;  // it would end the program first
  make_both(options);
  const Generation begin = robot->generation();
  controller.control({{"command", "stall_links"}, {"which", "rtde"}, {"clients", "control"}});
  EXPECT_FALSE(robot->control_for_queries()->setPayload(1.0, {0.0, 0.0, 0.0}));
  const Status possible = robot->motion_possible();
  EXPECT_TRUE(!possible || robot->generation() != begin) << "the robot has rejected the command";
  EXPECT_TRUE(possible || possible.error().code == ErrorCode::link_lost) << possible.error().message;
  controller.control(
      {{"command", "stall_links"}, {"which", "rtde"}, {"clients", "control"}, {"stalled", false}});
  EXPECT_TRUE(becomes_ready_again());
}

/// Before the status has changed: a call keeps the control interface from being closed.
TEST_F(RobotMotionTest, NamesTheProgramThatHasReplacedItsOwnAtEveryMoment)
{
  make_both();
  const auto call = robot->control_for_queries().hold();
  controller.run_other_program();
  Status possible;
  ASSERT_TRUE(eventually([&] { return !(possible = robot->motion_possible()); }));
  EXPECT_EQ(possible.error().code, ErrorCode::program_stopped) << possible.error().message;
}

TEST_F(RobotMotionTest, NamesTheProgramThatHasReplacedItsOwnInLocalControl)
{
  make_both();
  controller.run_other_program();
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::program_stopped));
  controller.control({{"command", "remote_control"}, {"on", false}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::not_ready));
  const Status possible = robot->motion_possible();
  ASSERT_FALSE(possible);
  EXPECT_EQ(possible.error().code, ErrorCode::program_stopped) << possible.error().message;
}

TEST_F(RobotMotionTest, NamesTheLostConnectionAfterWhichItsProgramHasEnded)
{
  make_both();
  const Lease lease = acquire();
  const std::uint32_t link = robot->generation().link;
  controller.control({{"command", "remote_control"}, {"on", false}});  // the program is not started again
  controller.control({{"command", "drop_links"}, {"which", "rtde"}});
  ASSERT_TRUE(eventually([&] { return robot->generation().link != link; }));
  ASSERT_TRUE(eventually([&] { return robot->latest()->runtime_state == RuntimeState::stopped; }));
  const Status valid = robot->is_valid(lease);
  ASSERT_FALSE(valid);
  EXPECT_EQ(valid.error().code, ErrorCode::link_lost) << valid.error().message;
}

TEST_F(RobotMotionTest, BlockingCallReturnsWhenTheConnectionIsLost)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  std::atomic<bool> returned{false};
  std::jthread blocked([&, control = control()] {
    control->moveJ(q, 0.5, 1.0);
    returned = true;
  });
  ASSERT_TRUE(eventually([&] { return robot->is_moving(); }));
  EXPECT_FALSE(returned);
  controller.control({{"command", "stall_links"}, {"which", "rtde"}});
  EXPECT_TRUE(eventually([&] { return returned.load(); }, 2s));
}

TEST_F(RobotMotionTest, BlockingCallDoesNotStarveTheWatchdog)
{
  make_both();
  auto q = robot->receive()->getActualQ();
  q[5] += 0.8;
  EXPECT_TRUE(control()->moveJ(q, 0.8, 3.0)) << log.text();
  EXPECT_NEAR(robot->latest()->actual_q[5], q[5], 1e-2);
  EXPECT_TRUE(robot->ready_to_move());
}

TEST_F(RobotMotionTest, SharesTheControlInterfaceWithQueriesOfManyThreads)
{
  make_both();
  move_joints();
  std::atomic<int> answers{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int n = 0; n < 10; ++n) {
          answers += robot->control_for_queries()->isSteady() ? 0 : 1;
        }
      });
    }
  }
  EXPECT_EQ(answers, 40) << "each call must return the correct answer";
  EXPECT_TRUE(robot->stop_motion());
}

}  // namespace
}  // namespace ur_ros_rtde::test
