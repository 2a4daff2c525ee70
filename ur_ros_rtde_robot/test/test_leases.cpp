// Who may move the arm.
#include <atomic>
#include <cmath>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "lease_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

TEST_F(LeaseTest, EndsWithItsProgramEvenIfTheNextOneRunsAlready)
{
  const Lease lease = acquire();
  move(lease);
  stop_and_start_program();
  ASSERT_TRUE(robot->ready_to_move());
  const Status may = robot->may_continue(lease);
  ASSERT_FALSE(may);
  EXPECT_EQ(may.error().code, ErrorCode::program_stopped) << may.error().message;
  EXPECT_THROW(robot->control(lease)->moveJ(robot->receive()->getActualQ(), 0.8, 2.0, true), RobotError);
  EXPECT_TRUE(stays_at_rest());
}

/// Not the connection, which is replaced because of it.
TEST_F(LeaseTest, NamesTheEndOfItsProgramWhileTheNextOneStarts)
{
  const Lease lease = acquire();
  controller.control({{"command", "stop_program"}});
  ASSERT_TRUE(eventually([&] { return !robot->ready_to_move(); }));
  ASSERT_TRUE(eventually([&] {
    const Status valid = robot->is_valid(lease);
    const Error cause = valid ? Error{} : valid.error();
    EXPECT_EQ(cause.code, ErrorCode::program_stopped) << cause.message;
    return HasFailure() || robot->ready_to_move();
  }));
}

TEST_F(LeaseTest, EndsWithItsConnection)
{
  const Lease lease = acquire();
  controller.control({{"command", "drop_links"}});
  ASSERT_TRUE(becomes_ready_again());
  const Status may = robot->may_continue(lease);
  ASSERT_FALSE(may);
  EXPECT_EQ(may.error().code, ErrorCode::link_lost) << may.error().message;
}

TEST_F(LeaseTest, NamesTheSafetyStopThatEndedItAfterItIsOver)
{
  const Lease lease = acquire();
  move(lease);
  controller.control({{"command", "safeguard"}, {"open", true}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::safeguard_stop));
  controller.control({{"command", "safeguard"}, {"open", false}});
  ASSERT_TRUE(becomes_ready_again());
  EXPECT_EQ(robot->may_continue(lease).error().code, ErrorCode::safeguard_stop);
}

TEST_F(LeaseTest, IsNotGrantedDuringHandGuiding)
{
  {
    Claim switching = claim();
    switching.switches_hand_guiding = true;
    const auto lease = robot->acquire(switching);
    ASSERT_TRUE(lease);
    ASSERT_TRUE(robot->control(*lease)->freedriveMode());
    EXPECT_TRUE(robot->activities().contains(Activity::freedrive));
  }
  for (const Resource resource : {Resource::motion, Resource::mode, Resource::script}) {
    const auto rejected = robot->acquire(claim(resource));
    ASSERT_FALSE(rejected);
    EXPECT_EQ(rejected.error().code, ErrorCode::busy);
    EXPECT_NE(rejected.error().message.find("freedrive"), std::string::npos);
  }
  EXPECT_TRUE(robot->acquire(claim(Resource::io)));
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_TRUE(robot->acquire(claim()));
}

/// They consist of several steps, between which a stop would find nothing to end.
TEST_F(LeaseTest, FunctionsThatReplaceTheProgramAreRejected)
{
  const Lease lease = acquire();
  const std::string script = "def f():\n  movej([0, 0, 0, 0, 0, 0])\nend\n";
  const std::vector<std::vector<double>> path{{0.0, -1.5, 1.5, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0}};
  EXPECT_THROW(robot->control(lease)->sendCustomScript(script), std::logic_error);
  EXPECT_THROW(robot->control(lease)->sendCustomScriptFunction("f", script), std::logic_error);
  EXPECT_THROW(robot->control(lease)->moveJ(path, true), std::logic_error);
  EXPECT_THROW(robot->control(lease)->moveL(path, true), std::logic_error);
  EXPECT_TRUE(robot->may_continue(lease)) << "the control program goes on";
  EXPECT_TRUE(at_rest());
}

TEST_F(LeaseTest, NothingMovesWithoutOne)
{
  const auto q = robot->receive()->getActualQ();
  const std::vector<double> turning{0.4, 0.0, 0.0, 0.0, 0.0, 0.0};
  const auto control = robot->control_for_queries();
  EXPECT_THROW(control->moveJ(q, 0.8, 2.0, true), std::logic_error);
  EXPECT_THROW(control->speedJ(turning, 2.0, 0.0), std::logic_error);
  EXPECT_THROW(control->servoJ(q, 0.0, 0.0, 0.002, 0.05, 300.0), std::logic_error);
  EXPECT_THROW(control->freedriveMode(), std::logic_error);
  EXPECT_THROW(control->reuploadScript(), std::logic_error);
  EXPECT_THROW(control->stopScript(), std::logic_error);
  EXPECT_TRUE(control->isSteady()) << "a query works";
  EXPECT_TRUE(robot->activities().empty());
  const auto of_outputs = robot->acquire({.resource = Resource::io, .owner = "/other"});
  ASSERT_TRUE(of_outputs);
  EXPECT_THROW(robot->control(*of_outputs)->speedJ(turning, 2.0, 0.0), RobotError)
      << "a lease of another resource";
  const Lease lease = acquire();
  EXPECT_TRUE(robot->control(lease)->speedJ(turning, 2.0, 0.0)) << "the holder of a lease may move the arm";
  EXPECT_TRUE(robot->stop_motion());
}

TEST_F(LeaseTest, IsNotGrantedToAClaimThatWaitedWhenTheSafeguardStopIsOver)
{
  std::optional<Lease> held;
  Claim holder = claim();
  std::atomic<bool> asked{false};
  holder.preempt = [&](const Error &) { asked = true; };
  held = std::move(*robot->acquire(holder));
  move(*held);
  std::future<Expected<Lease>> next =
      std::async(std::launch::async, [&] { return robot->acquire_preempting(claim(), {.timeout = 60s}); });
  ASSERT_TRUE(eventually([&] { return asked.load(); }));
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(comes_to(RobotState::stopped, ErrorCode::safeguard_stop));
  held.reset();
  ASSERT_EQ(next.wait_for(10s), std::future_status::ready) << "it waits for the end of the safeguard stop";
  const auto rejected = next.get();
  ASSERT_FALSE(rejected);
  EXPECT_EQ(rejected.error().code, ErrorCode::safeguard_stop);
  controller.control({{"command", "safeguard"}, {"open", false}});
}

/// A stop of the driver has ended the control program, which does not start again.
struct EndedProgramTest : LeaseTest {
  void SetUp() override
  {
    auto options = robot_options();
    options.restart_program = false;
    make_both_slow(options);
    before = robot->generation();
    lease = acquire();
    end_program(lease);
    ASSERT_FALSE(robot->latest()->is_program_running());
    ASSERT_TRUE(robot->is_continued(before));
  }

  Generation before;
  Lease lease;
};

TEST_F(EndedProgramTest, IsNotContinuedAfterASafeguardStopThatIsOver)
{
  controller.control({{"command", "safeguard"}});
  ASSERT_TRUE(eventually([&] { return robot->latest()->safety().safeguard_stopped; }));
  controller.control({{"command", "safeguard"}, {"open", false}});
  ASSERT_TRUE(eventually([&] { return !robot->latest()->safety().safeguard_stopped; }));
  const Status continued = robot->is_continued(before);
  ASSERT_FALSE(continued) << "a claim that waits for the program would move the arm";
  EXPECT_EQ(continued.error().code, ErrorCode::safeguard_stop) << continued.error().message;
}

TEST_F(EndedProgramTest, IsNotAwaitedByAClaimThatDoesNotNeedIt)
{
  lease.release();
  auto claimed = std::async(std::launch::async, [&] {
    return robot->acquire_preempting(claim(), {.timeout = 60s, .since = before, .for_program = false});
  });
  EXPECT_EQ(claimed.wait_for(20s), std::future_status::ready);
  const auto granted = claimed.get();
  ASSERT_FALSE(granted);
  EXPECT_EQ(granted.error().code, ErrorCode::program_stopped) << granted.error().message;
}

TEST_F(EndedProgramTest, IsNotTheReasonForWhichAHolderThatWasStoppedCannotMoveTheArm)
{
  try {
    robot->control(lease)->stopJ(1.0);
    FAIL() << "it was stopped";
  } catch (const RobotError & error) {
    EXPECT_EQ(error.error().message, stopped_by_the_driver().message);
  }
}

/// What is in the way may be in the way for long, and the arm must not move when it is over.
TEST_F(LeaseTest, IsNotAwaitedForTheEndOfHandGuiding)
{
  const Generation before = robot->generation();
  {
    const Lease lease = acquire();
    end_program(lease);
  }
  ASSERT_TRUE(becomes_ready_again());
  Claim switching = claim();
  switching.switches_hand_guiding = true;
  {
    const auto guiding = robot->acquire(switching);
    ASSERT_TRUE(guiding) << guiding.error().message;
    ASSERT_TRUE(robot->control(*guiding)->freedriveMode());
  }
  auto claimed = std::async(std::launch::async, [&] {
    return robot->acquire_preempting(claim(), {.timeout = 60s, .since = before});
  });
  EXPECT_EQ(claimed.wait_for(20s), std::future_status::ready);
  const auto granted = claimed.get();
  ASSERT_FALSE(granted);
  EXPECT_EQ(granted.error().code, ErrorCode::busy) << granted.error().message;
}

TEST_F(LeaseTest, IsNotGrantedToAClaimThatAStopHasOvertaken)
{
  Claim holder = claim();
  std::atomic<bool> asked{false};
  holder.preempt = [&](const Error &) { asked = true; };
  std::optional<Lease> held = std::move(*robot->acquire(holder));
  move(*held);
  Expected<Lease> newer;
  std::future<Expected<Lease>> next = std::async(std::launch::async, [&] {
    return robot->acquire_preempting(claim(), {.timeout = 60s, .may_go_on = [&] {
                                                 newer = robot->acquire(claim());
                                                 return false;
                                               }});
  });
  ASSERT_TRUE(eventually([&] { return asked.load(); }));
  const auto stopping = robot->begin_stop({}, stopped_by_the_driver());
  held.reset();
  ASSERT_TRUE(stopping.get());
  EXPECT_FALSE(next.get());
  ASSERT_TRUE(newer) << newer.error().message;
  EXPECT_TRUE(robot->may_continue(*newer)) << "it was preempted by a claim from before the stop";
}

/// The holder that a stop tells to end gives the arm back at once, while it still moves. A claim that does
/// not wait for the program waits for the standstill too.
TEST_F(LeaseTest, IsNotGrantedBetweenTheReleaseOfAnotherAndTheStandstillOfItsArm)
{
  Claim holder = claim();
  std::atomic<bool> asked{false};
  holder.preempt = [&](const Error &) { asked = true; };
  std::optional<Lease> held = std::move(*robot->acquire(holder));
  move(*held);
  std::atomic<bool> was_moving{false};
  std::future<Expected<Lease>> next = std::async(std::launch::async, [&] {
    auto lease = robot->acquire_preempting(claim(), {.timeout = 60s, .for_program = false});
    was_moving = robot->is_moving();
    return lease;
  });
  ASSERT_TRUE(eventually([&] { return asked.load(); }));
  StopOptions gentle;
  gentle.joint_deceleration = 1.0;
  const auto stopping = robot->begin_stop(gentle, stopped_by_the_driver());
  held.reset();
  EXPECT_TRUE(robot->is_stopping()) << "the arm was at rest before the release";
  ASSERT_EQ(next.wait_for(40s), std::future_status::ready);
  const auto granted = next.get();
  ASSERT_TRUE(granted) << granted.error().message;
  EXPECT_FALSE(was_moving) << "it was granted while the arm moved";
  ASSERT_EQ(stopping.wait_for(0s), std::future_status::ready);
  EXPECT_TRUE(stopping.get());
  EXPECT_TRUE(stays_at_rest());
}

/// The thread of the goal that preempts is late: the stop has ended the program before.
TEST_F(LeaseTest, IsGrantedToALateClaimAfterAStopThatHasEndedTheProgram)
{
  const Generation since = robot->generation();
  {
    const auto lease = robot->acquire(claim());
    ASSERT_TRUE(lease) << lease.error().message;
    auto q = robot->receive()->getActualQ();
    q[0] += 3.0;
    const std::jthread blocked([&] { robot->control(*lease)->moveJ(q, 0.8, 2.0); });
    ASSERT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_qd[0]) > 0.7; }));
    const auto stopped = robot->stop_motion();
    ASSERT_TRUE(stopped) << stopped.error().message;
    ASSERT_EQ(stopped->means, StopMeans::program_stopped);
  }
  const auto next = robot->acquire_preempting(claim(), {.timeout = 20s, .since = since});
  EXPECT_TRUE(next) << next.error().message;
}

TEST_F(LeaseTest, IsGrantedAfterTheStopOfThePreviousHolder)
{
  std::optional<Lease> held;
  Claim holder = claim();
  std::jthread leaving;
  holder.preempt = [&](const Error & why) {
    robot->request_stop(*held, {}, why, 1s);
    leaving = std::jthread([&] {
      EXPECT_TRUE(robot->end_motion(*held, {}));
      held.reset();
    });
  };
  held = std::move(*robot->acquire(holder));
  move(*held);
  const auto next = robot->acquire_preempting(claim(), {.timeout = 10s});
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_TRUE(at_rest());
  EXPECT_TRUE(robot->may_continue(*next));
}

}  // namespace
}  // namespace ur_ros_rtde::test
