// What takes the arm out of the hands of its holder.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "lease_fixture.hpp"

namespace ur_ros_rtde::test {
namespace {

struct HolderTest : LeaseTest {
  void start_recording()
  {
    recording = true;
    begin_ = robot->latest()->controller_time;
  }
  /// s from start_recording() to the first cycle in which joint 0 is slower than before.
  double time_to_deceleration()
  {
    double speed = 0.0;
    for (const Sample & sample : recorded()) {
      const double now = std::abs(sample.target_qd[0]);
      if (now < speed - 1e-6) {
        return sample.controller_time - begin_;
      }
      speed = now;
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  double begin_ = 0.0;
};

constexpr double stop_begins_within = 0.02;  // s, docs/use/safety.md

TEST_F(HolderTest, AStopTakesTheArmFromAHolderThatDoesNotLook)
{
  Claim holder = claim();
  std::optional<Error> told;
  holder.preempt = [&](const Error & why) { told = why; };
  const auto lease = robot->acquire(holder);
  ASSERT_TRUE(lease);
  move(*lease);
  start_recording();
  const auto report = robot->stop_motion({}, Error{ErrorCode::preempted, "preempted by /stop"});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
  EXPECT_NEAR(highest_deceleration(0), 2.0, 0.3);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->message, "preempted by /stop");
  try {
    robot->control(*lease)->moveJ(robot->receive()->getActualQ(), 0.8, 2.0, true);
    ADD_FAILURE() << "the holder can still move the arm";
  } catch (const RobotError & error) {
    EXPECT_EQ(error.error().message, "preempted by /stop");
  }
  EXPECT_TRUE(stays_at_rest());
}

TEST_F(HolderTest, AStopDoesNotWaitForAHolderThatKeepsTheInterfaceLocked)
{
  const Lease lease = acquire();
  move(lease);
  std::atomic<bool> locked{false};
  std::atomic<bool> release{false};
  std::jthread holder([&] {
    const auto held = robot->control(lease).hold();
    locked = true;
    eventually([&] { return release.load(); });
  });
  ASSERT_TRUE(eventually([&] { return locked.load(); }));
  start_recording();
  const auto report = robot->stop_motion();
  release = true;
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
}

TEST_F(HolderTest, AStopDoesNotWaitForABlockingMotion)
{
  const Lease lease = acquire();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  std::jthread blocked([&, control = robot->control(lease)] { EXPECT_FALSE(control->moveJ(q, 0.8, 2.0)); });
  ASSERT_TRUE(eventually([&] { return std::abs(robot->latest()->actual_qd[0]) > 0.7; }));
  start_recording();
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::program_stopped)
      << "the control program reads no command while it moves";
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
  EXPECT_TRUE(stays_at_rest());
}

TEST_F(HolderTest, AStopEndsACallThatIsAboutToStartAMotion)
{
  const Lease lease = acquire();
  auto q = robot->receive()->getActualQ();
  q[0] += 3.0;
  std::atomic<bool> permitted{false};
  std::atomic<bool> stopped{false};
  std::jthread late([&] {
    const auto held = robot->control(lease).hold();
    permitted = true;
    eventually([&] { return stopped.load(); });
    EXPECT_FALSE(held->moveJ(q, 0.8, 2.0, true));
  });
  ASSERT_TRUE(eventually([&] { return permitted.load(); }));
  const auto report = robot->stop_motion();
  stopped = true;
  late.join();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::program_stopped) << "the call keeps the control interface";
  EXPECT_TRUE(stays_at_rest());
}

TEST_F(HolderTest, AStopOfAnArmAtRestWaitsForNoQuery)
{
  const Lease lease = acquire();
  const auto query = robot->control_for_queries().hold();
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::nothing_moved);
  EXPECT_FALSE(robot->may_continue(lease));
}

TEST_F(HolderTest, AStrongerStopReplacesAGentleOne)
{
  const Lease lease = acquire();
  move(lease);
  StopOptions gentle;
  gentle.joint_deceleration = 0.2;
  const auto first = robot->begin_stop(gentle, stopped_by_the_driver());
  ASSERT_TRUE(eventually([&] { return std::abs(robot->latest()->target_qd[0]) < 0.79; }));
  EXPECT_TRUE(robot->is_stopping());
  EXPECT_FALSE(robot->acquire(claim())) << "the arm is being stopped";
  start_recording();
  StopOptions strong;
  strong.joint_deceleration = 4.0;
  const auto second = robot->stop_motion(strong);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->means, StopMeans::stop_command);
  EXPECT_NEAR(highest_deceleration(0), 4.0, 0.5);
  EXPECT_TRUE(first.get());
  EXPECT_TRUE(stays_at_rest());
}

TEST_F(HolderTest, AGentleStopMayTakeItsTime)
{
  const Lease lease = acquire();
  move(lease);
  StopOptions gentle;
  gentle.joint_deceleration = 0.4;
  const double expected = std::abs(robot->latest()->target_qd[0]) / gentle.joint_deceleration;
  EXPECT_GT(expected, 1.75);
  const auto report = robot->stop_motion(gentle);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_NEAR(report->time_to_standstill, expected, 0.2);
}

TEST_F(HolderTest, AStopEndsAMotionBeforeForceMode)
{
  const Lease lease = acquire();
  ASSERT_TRUE(robot->control(lease)->forceMode({0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, 2,
                                               {0.1, 0.1, 0.01, 0.1, 0.1, 0.1}));
  move(lease);
  const auto generation = robot->generation();
  start_recording();
  const auto report = robot->stop_motion();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->means, StopMeans::stop_command);
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
  EXPECT_NEAR(highest_deceleration(0), 2.0, 0.3);
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_TRUE(robot->is_current(generation)) << "the control program goes on";
}

TEST_F(HolderTest, TheEndOfAHolderStopsWhatItHasStarted)
{
  Lease lease = acquire();
  ASSERT_TRUE(robot->control(lease)->speedL({0.0, 0.0, 0.05, 0.0, 0.0, 0.0}, 0.5, 0.0));
  EXPECT_TRUE(robot->activities().contains(Activity::linear_speed)) << "even before the arm moves";
  const auto report = robot->end_motion(lease, {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(robot->activities().empty());
  EXPECT_TRUE(stays_at_rest());
}

TEST_F(HolderTest, TheEndOfAHolderCanLeaveModesActive)
{
  Lease lease = acquire();
  ASSERT_TRUE(robot->control(lease)->forceMode({0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, 2,
                                               {0.1, 0.1, 0.01, 0.1, 0.1, 0.1}));
  move(lease);
  StopOptions options;
  options.keep = Activity::force_mode;
  ASSERT_TRUE(robot->end_motion(lease, options));
  EXPECT_EQ(robot->activities(), Activities(Activity::force_mode));
  lease.release();
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_TRUE(robot->activities().empty());
}

TEST_F(HolderTest, AHolderThatBrakesByItselfMayFinish)
{
  using Clock = std::chrono::steady_clock;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const Lease lease = acquire();
    move(lease);
    const Robot::Braking braking(lease);
    auto last = Clock::now();
    Clock::duration longest{};
    robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
    for (int i = 0; i < 40; ++i) {
      braking.sent();
      longest = std::max(longest, Clock::now() - std::exchange(last, Clock::now()));
      std::this_thread::sleep_for(2ms);
    }
    if (longest < 8ms) {  // otherwise this thread was late, and the stop has rightly taken over
      EXPECT_TRUE(robot->may_continue(lease));
      EXPECT_FALSE(robot->is_stopping());
      return;
    }
    ASSERT_TRUE(robot->stop_motion());
    ASSERT_TRUE(becomes_ready());
  }
  FAIL() << "this thread was late in every attempt";
}

TEST_F(HolderTest, AHolderThatDoesNotBeginToBrakeIsStopped)
{
  const Lease lease = acquire();
  move(lease);
  const Robot::Braking braking(lease);
  start_recording();
  robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
  EXPECT_EQ(robot->may_continue(lease).error().code, ErrorCode::canceled);
}

TEST_F(HolderTest, TheEndOfAnotherHolderDoesNotEndTheSupervisionOfOneThatBrakes)
{
  const Lease lease = acquire();
  const Lease mode = acquire(Resource::mode);
  move(lease);
  const Robot::Braking braking(lease);
  robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
  robot->request_stop(mode, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_EQ(robot->may_continue(lease).error().code, ErrorCode::canceled);
}

TEST_F(HolderTest, AHolderThatHangsWhileItBrakesIsStopped)
{
  const Lease lease = acquire();
  move(lease);
  const Robot::Braking braking(lease);
  robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
  braking.sent();
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_FALSE(robot->may_continue(lease));
}

TEST_F(HolderTest, AHolderThatBrakesForTooLongIsStopped)
{
  const Lease lease = acquire();
  move(lease);
  const Robot::Braking braking(lease);
  robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 200ms);
  ASSERT_TRUE(eventually([&] {
    braking.sent();
    return !robot->may_continue(lease);
  }));
  EXPECT_TRUE(eventually([&] { return at_rest(); }));
}

/// As the shutdown of the driver after a cancel.
TEST_F(HolderTest, ALaterRequestShortensTheStopUnderWay)
{
  const Lease lease = acquire();
  move(lease);
  StopOptions gentle;
  gentle.joint_deceleration = 0.1;
  robot->request_stop(lease, gentle, Error{ErrorCode::canceled, "canceled"}, 10s);
  ASSERT_TRUE(eventually([&] { return robot->is_stopping(); }));
  const double begin = robot->latest()->controller_time;
  StopOptions hurried = gentle;
  hurried.timeout = 200ms;
  robot->request_stop(lease, hurried, Error{ErrorCode::shutdown, "shutting down"}, 200ms);
  ASSERT_TRUE(eventually([&] { return at_rest(); }));
  EXPECT_LT(robot->latest()->controller_time - begin, 2.5) << "0.8 rad/s at 0.1 rad/s^2 take 8 s";
}

TEST_F(HolderTest, AStopTakesTheArmFromAHolderThatBrakesByItself)
{
  const Lease lease = acquire();
  move(lease);
  const Robot::Braking braking(lease);
  robot->request_stop(lease, {}, Error{ErrorCode::canceled, "canceled"}, 10s);
  braking.sent();
  start_recording();
  ASSERT_TRUE(robot->stop_motion());
  EXPECT_LE(time_to_deceleration(), stop_begins_within);
}

}  // namespace
}  // namespace ur_ros_rtde::test
