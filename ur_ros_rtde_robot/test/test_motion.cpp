#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "motion/motion_blocker.hpp"
#include "motion/motion_tracker.hpp"
#include "ur_ros_rtde_robot/motion/motion.hpp"

namespace ur_ros_rtde {
namespace {

Sample moving_at(double joint_velocity, double controller_time)
{
  Sample sample{};
  sample.actual_qd = {0.0, 0.0, joint_velocity, 0.0, 0.0, 0.0};
  sample.controller_time = controller_time;
  return sample;
}

TEST(StandstillDetectorTest, RequiresSeveralCyclesOfRest)
{
  StandstillDetector detector;
  detector.add(moving_at(0.0, 1.000));
  EXPECT_FALSE(detector.at_rest());
  detector.add(moving_at(0.001, 1.010));
  EXPECT_FALSE(detector.at_rest());
  detector.add(moving_at(-0.001, 1.020));
  EXPECT_TRUE(detector.at_rest());
}

TEST(StandstillDetectorTest, RestartsWhenAJointMoves)
{
  StandstillDetector detector;
  detector.add(moving_at(0.0, 1.000));
  detector.add(moving_at(0.0, 1.030));
  ASSERT_TRUE(detector.at_rest());
  detector.add(moving_at(-0.5, 1.032));
  EXPECT_FALSE(detector.at_rest());
  detector.add(moving_at(0.0, 1.034));
  EXPECT_FALSE(detector.at_rest());
}

TEST(StandstillDetectorTest, TreatsNaNAsMotion)
{
  StandstillDetector detector;
  detector.add(moving_at(0.0, 1.0));
  detector.add(moving_at(std::numeric_limits<double>::quiet_NaN(), 1.1));
  EXPECT_FALSE(detector.at_rest());
}

TEST(StandstillDetectorTest, RestartsAfterAReconnection)
{
  StandstillDetector detector;
  detector.add(moving_at(0.0, 1.0));
  auto later = moving_at(0.0, 5.0);
  later.link = 1;
  detector.add(later);
  EXPECT_FALSE(detector.at_rest());
}

constexpr unsigned operation_shift = 24;
constexpr std::uint32_t running_bit = 1U << 15U;

/// Feeds a MotionTracker with one package per cycle of a control program that has run one operation.
struct ArrivalTest : testing::Test {
  MotionTracker tracker;
  Sample sample{};

  void SetUp() override
  {
    sample.runtime_state = RuntimeState::playing;
    add(1U << 16U);
    add(2U << 16U);  // the program has written its status
  }
  bool add(std::uint32_t status)
  {
    sample.async = {status};
    ++sample.sequence;
    sample.controller_time += 0.002;
    tracker.add(sample);
    return tracker.view().at_rest;
  }
  /// A move that ends with this package, one cycle after the arm has moved.
  bool end_move()
  {
    const auto actual = std::exchange(sample.actual_qd, Vector6{0.5});
    const auto target = std::exchange(sample.target_qd, Vector6{0.5});
    add(1U << operation_shift | running_bit);
    sample.actual_qd = actual;
    sample.target_qd = target;
    return add(1U << operation_shift);
  }
};

TEST(StopTest, IsNotConfirmedForTheCauseOfItsGoalWhichIsNamedOnce)
{
  const Error canceled{ErrorCode::canceled, "canceled"};
  const Error lost{ErrorCode::link_lost, "nothing comes from 127.0.0.1"};
  const Error stop{ErrorCode::link_lost, "cannot tell the robot to stop: nothing comes from 127.0.0.1"};
  EXPECT_EQ(standstill_not_confirmed(canceled, stop).code, ErrorCode::canceled);
  EXPECT_EQ(standstill_not_confirmed(canceled, stop).message,
            "canceled; standstill is not confirmed: " + stop.message);
  EXPECT_EQ(standstill_not_confirmed(lost, stop).message, "standstill is not confirmed: " + stop.message);
}

TEST(MotionTrackerTest, CountsAProgramThatIsFoundPausedAsEnded)
{
  MotionTracker tracker;
  Sample sample{};
  const auto programs_after = [&](RuntimeState state) {
    sample.runtime_state = state;
    ++sample.sequence;
    tracker.add(sample);
    return tracker.view().program;
  };
  const auto begin = programs_after(RuntimeState::stopped);
  EXPECT_EQ(programs_after(RuntimeState::pausing), begin + 1) << "it was started and paused in between";
  EXPECT_EQ(programs_after(RuntimeState::paused), begin + 1);
  EXPECT_EQ(programs_after(RuntimeState::resuming), begin + 1);
  EXPECT_EQ(programs_after(RuntimeState::playing), begin + 1);
  EXPECT_EQ(programs_after(RuntimeState::pausing), begin + 2);
  EXPECT_EQ(programs_after(RuntimeState::paused), begin + 2);
  EXPECT_EQ(programs_after(RuntimeState::stopped), begin + 2);
  EXPECT_EQ(programs_after(RuntimeState::playing), begin + 2);
}

TEST(MotionTrackerTest, CountsTheStopsOfTheRobotWithAndWithoutAProgram)
{
  MotionTracker tracker;
  Sample sample{};
  sample.robot_mode = RobotMode::running;
  constexpr std::uint32_t normal = 1;
  constexpr std::uint32_t safeguard_stop = 1U << 4U;
  const auto stops_after = [&](RuntimeState state, std::uint32_t safety) {
    sample.runtime_state = state;
    sample.safety_status_bits = safety;
    ++sample.sequence;
    tracker.add(sample);
    return tracker.view().robot_stops;
  };
  const auto begin = stops_after(RuntimeState::stopped, normal);
  EXPECT_EQ(stops_after(RuntimeState::stopped, safeguard_stop), begin + 1);
  EXPECT_EQ(tracker.stop_cause().code, ErrorCode::safeguard_stop);
  EXPECT_EQ(tracker.end_cause().code, ErrorCode::none) << "no program has ended";
  EXPECT_EQ(stops_after(RuntimeState::stopped, safeguard_stop), begin + 1);
  EXPECT_EQ(stops_after(RuntimeState::playing, normal), begin + 1);
  EXPECT_EQ(stops_after(RuntimeState::playing, safeguard_stop), begin + 2);
  EXPECT_EQ(stops_after(RuntimeState::stopped, safeguard_stop), begin + 2);
  EXPECT_EQ(stops_after(RuntimeState::stopped, normal), begin + 2);
}

TEST_F(ArrivalTest, IsProvenByThePackageInWhichTheOperationEnds)
{
  EXPECT_TRUE(end_move());
  EXPECT_TRUE(add(1U << operation_shift));
}

TEST_F(ArrivalTest, IsNotProvenByTheTargetAlone)
{
  sample.actual_qd[3] = 0.011;
  EXPECT_FALSE(end_move());
  sample.actual_qd[3] = 0.009;
  EXPECT_TRUE(add(1U << operation_shift)) << "the arm has followed";
}

TEST_F(ArrivalTest, IsNotProvenWhereAnOscillatingArmTurnsAround)
{
  sample.target_q[1] = 0.5;
  sample.actual_q[1] = 0.502;
  EXPECT_FALSE(end_move());
}

TEST_F(ArrivalTest, IsNotProvenWhileTheTargetMoves)
{
  sample.target_qd[5] = 1e-9;
  EXPECT_FALSE(end_move());
  sample.target_qd[5] = 0.0;
  EXPECT_FALSE(add(1U << operation_shift)) << "something else has moved the target";
}

TEST_F(ArrivalTest, IsNotProvenWhileTheOperationRuns)
{
  add(1U << operation_shift | running_bit);
  sample.actual_qd[0] = 0.5;
  add(1U << operation_shift | running_bit);
  sample.actual_qd[0] = 0.0;
  EXPECT_FALSE(add(1U << operation_shift | running_bit)) << "a stop at a waypoint";
}

TEST_F(ArrivalTest, DoesNotApplyOnceTheArmHasLeftTheTarget)
{
  EXPECT_TRUE(end_move());
  sample.actual_qd[2] = 0.5;
  EXPECT_FALSE(add(1U << operation_shift));
  sample.actual_qd[2] = 0.0;
  EXPECT_FALSE(add(1U << operation_shift)) << "compliant motion turns around";
}

TEST_F(ArrivalTest, DoesNotApplyToAnotherProgram)
{
  sample.runtime_state = RuntimeState::stopped;
  EXPECT_FALSE(end_move());
  sample.runtime_state = RuntimeState::playing;
  EXPECT_FALSE(add(1U << operation_shift));
  EXPECT_FALSE(add(3U << 16U)) << "the new program has written its first status";
}

TEST_F(ArrivalTest, TreatsNaNAsMotion)
{
  sample.actual_q[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(end_move());
}

TEST_F(ArrivalTest, IsProvenForAnOperationBetweenTwoPackages)
{
  sample.actual_qd[0] = 0.5;
  add(2U << 16U);
  sample.actual_qd[0] = 0.0;
  EXPECT_TRUE(add(1U << operation_shift));
}

TEST_F(ArrivalTest, IgnoresASampleThatItHas)
{
  EXPECT_TRUE(end_move());
  auto old = sample;
  old.sequence -= 1;
  old.actual_qd[0] = 0.5;
  tracker.add(old);
  EXPECT_TRUE(tracker.view().at_rest);
}

TEST(AsyncStatusTest, DecodesTheControlScriptsWord)
{
  // operation 3, change 5, running, waypoint 2
  const AsyncStatus status{3U << 24U | 5U << 16U | 1U << 15U | 2U};
  EXPECT_EQ(status.operation(), 3U);
  EXPECT_EQ(status.changes(), 5U);
  EXPECT_TRUE(status.running());
  EXPECT_EQ(status.progress(), 2U);
}

/// The two statuses come over different connections, one of which may be ahead.
TEST(AsyncStatusTest, TellsWhetherAnOperationHasBegunSince)
{
  const auto status = [](unsigned operation, bool running) {
    return AsyncStatus{operation << 24U | (running ? 1U << 15U : 0U)};
  };
  const AsyncStatus before = status(3, true);
  EXPECT_FALSE(status(3, true).has_begun_since(before));
  EXPECT_FALSE(status(3, false).has_begun_since(before)) << "the previous operation has ended";
  EXPECT_FALSE(status(2, false).has_begun_since(before)) << "an older status";
  EXPECT_TRUE(status(4, true).has_begun_since(before));
  EXPECT_TRUE(status(5, false).has_begun_since(before));
  EXPECT_TRUE(status(0, true).has_begun_since(status(127, false))) << "the number starts again";
  EXPECT_FALSE(status(127, false).has_begun_since(status(0, true)));
}

Sample running_robot()
{
  Sample sample{};
  sample.robot_mode = RobotMode::running;
  sample.safety_mode = SafetyMode::normal;
  sample.safety_status_bits = 1;
  return sample;
}

TEST(MotionBlockerTest, IsEmptyForARunningRobot)
{
  EXPECT_FALSE(motion_blocker(running_robot()));
  auto reduced = running_robot();
  reduced.safety_status_bits = 2;
  EXPECT_FALSE(motion_blocker(reduced));
}

TEST(MotionBlockerTest, NamesEverySafetyStopWithTheRemedy)
{
  const std::vector<std::tuple<unsigned, ErrorCode, const char *>> table{
      {2, ErrorCode::protective_stop, "make_ready (or dashboard/unlock_protective_stop)"},
      {3, ErrorCode::safety_violation, "recovery mode"},
      {4, ErrorCode::safeguard_stop, "guard"},
      {5, ErrorCode::emergency_stop, "release the button, then make_ready"},
      {6, ErrorCode::emergency_stop, "release the button, then make_ready"},
      {7, ErrorCode::emergency_stop, "release the button, then make_ready"},
      {8, ErrorCode::safety_violation, "make_ready with restart_safety: true (or dashboard/restart_safety"},
      {9, ErrorCode::safety_violation, "make_ready with restart_safety: true (or dashboard/restart_safety"},
      {10, ErrorCode::safeguard_stop, "the cause that the pendant shows"}};
  for (const auto & [bit, code, advice] : table) {
    auto sample = running_robot();
    sample.safety_status_bits = 1U << bit;
    const auto condition = motion_blocker(sample);
    ASSERT_TRUE(condition) << "bit " << bit;
    EXPECT_EQ(condition->code, code) << "bit " << bit;
    EXPECT_NE(condition->message.find(advice), std::string::npos) << condition->message;
  }
}

TEST(MotionBlockerTest, ExplainsHowToPowerTheArm)
{
  auto sample = running_robot();
  sample.robot_mode = RobotMode::power_off;
  EXPECT_NE(motion_blocker(sample)->message.find("make_ready (or dashboard/power_on"), std::string::npos);
  sample.robot_mode = RobotMode::idle;
  EXPECT_NE(motion_blocker(sample)->message.find("make_ready (or dashboard/brake_release"),
            std::string::npos);
}

}  // namespace
}  // namespace ur_ros_rtde
