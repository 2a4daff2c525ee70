#include <gtest/gtest.h>

#include <vector>

#include "support/robot_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::RobotFixture;
using testing::six;

constexpr auto power_off_first = false;

TEST(PowerTest, PowersOnThroughBootingAndIdleWithDelays)
{
  RobotFixture fixture("ur10e", {}, power_off_first);
  fixture.run(0.1);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
  ASSERT_TRUE(fixture.safety.power_on());
  std::vector<RobotMode> seen;
  const double time = fixture.until(
      [&] {
        if (seen.empty() || seen.back() != fixture.state.robot_mode) {
          seen.push_back(fixture.state.robot_mode);
        }
        return fixture.state.robot_mode == RobotMode::idle;
      },
      5.0);
  EXPECT_EQ(seen,
            (std::vector{RobotMode::power_off, RobotMode::booting, RobotMode::power_on, RobotMode::idle}));
  EXPECT_NEAR(time, 1.5, 0.02);
  fixture.run(5.0);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::idle);
  EXPECT_EQ(fixture.state.joint_modes[0], 255);
  ASSERT_TRUE(fixture.safety.brake_release());
  EXPECT_NEAR(fixture.until([&] { return fixture.state.robot_mode == RobotMode::running; }, 5.0), 1.0, 0.02);
  EXPECT_EQ(fixture.state.joint_modes[5], 253);
}

TEST(PowerTest, BrakeReleasePowersOnFirst)
{
  RobotFixture fixture("ur10e", {}, power_off_first);
  ASSERT_TRUE(fixture.safety.brake_release());
  fixture.until([&] { return fixture.state.robot_mode == RobotMode::running; }, 5.0);
}

TEST(PowerTest, DelaysAreConfigurable)
{
  SafetyTimes times;
  times.power_on = 0.1;
  times.brake_release = 0.05;
  RobotFixture fixture("ur10e", times, power_off_first);
  ASSERT_TRUE(fixture.safety.brake_release());
  EXPECT_LT(fixture.until([&] { return fixture.state.robot_mode == RobotMode::running; }, 5.0), 0.2);
}

TEST(PowerTest, PowerOffDuringAMotionDeceleratesFirst)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  fixture.run(0.5);
  ASSERT_TRUE(fixture.safety.power_off());
  double last_speed = fixture.state.actual.velocity[0];
  fixture.until(
      [&] {
        EXPECT_LE(fixture.state.actual.velocity[0], last_speed + 1e-9);
        EXPECT_TRUE(fixture.state.robot_mode == RobotMode::running || last_speed < 0.01);
        last_speed = fixture.state.actual.velocity[0];
        return fixture.state.robot_mode == RobotMode::power_off;
      },
      1.0);
  EXPECT_EQ(fixture.stopped, 1);
  fixture.run(3.0);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
}

TEST(ProtectiveStopTest, StopsTheArmPausesTheProgramAndKeepsThePower)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  fixture.run(0.5);
  fixture.safety.trigger_protective_stop("somebody leant on the robot");
  const double time = fixture.until([&] { return fixture.arm.at_rest(); }, 1.0);
  EXPECT_LT(time, 0.2);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::protective_stop);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::running);
  EXPECT_EQ(fixture.paused, 1);
  EXPECT_EQ(fixture.stopped, 0);
  EXPECT_NE(fixture.log().find("protective stop: somebody leant on the robot"), std::string::npos);
  EXPECT_FALSE(fixture.arm.move_joint(default_position(fixture.model), {1.4, 1.05}));
}

TEST(ProtectiveStopTest, CannotBeUnlockedBeforeFiveSecondsHavePassed)
{
  RobotFixture fixture;
  fixture.step();
  fixture.safety.trigger_protective_stop("test");
  fixture.run(4.9);
  const auto early = fixture.safety.unlock_protective_stop();
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().find("5 s"), std::string::npos) << early.error();
  fixture.run(0.2);
  EXPECT_TRUE(fixture.safety.unlock_protective_stop());
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
  EXPECT_TRUE(fixture.arm.move_joint(default_position(fixture.model), {1.4, 1.05}));
}

TEST(ProtectiveStopTest, IsOnlyLoggedWhileStopped)
{
  RobotFixture fixture;
  fixture.step();
  fixture.safety.trigger_protective_stop("first");
  fixture.run(4.0);
  fixture.safety.trigger_protective_stop("second");
  fixture.run(1.5);
  EXPECT_EQ(fixture.paused, 1);
  EXPECT_TRUE(fixture.safety.unlock_protective_stop());
  EXPECT_NE(fixture.log().find("second"), std::string::npos);
}

TEST(ProtectiveStopTest, IsNotTriggeredWithoutPower)
{
  RobotFixture fixture("ur10e", {}, power_off_first);
  fixture.safety.trigger_protective_stop("nobody");
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
  EXPECT_FALSE(fixture.safety.unlock_protective_stop());
}

TEST(EmergencyStopTest, StopsArmPausesProgramAndCutsThePowerAtStandstill)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  fixture.run(0.5);
  fixture.safety.press_emergency_stop();
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::robot_emergency_stop);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::running);
  const double time = fixture.until([&] { return fixture.state.robot_mode == RobotMode::power_off; }, 1.0);
  EXPECT_LT(time, 0.25);
  EXPECT_EQ(fixture.stopped, 0);
  EXPECT_EQ(fixture.paused, 1);
}

TEST(EmergencyStopTest, LatchesUntilReleasedAndLeavesTheRobotPoweredOff)
{
  RobotFixture fixture;
  fixture.safety.press_emergency_stop();
  fixture.run(1.0);
  EXPECT_FALSE(fixture.safety.power_on());
  EXPECT_FALSE(fixture.safety.brake_release());
  ASSERT_TRUE(fixture.safety.release_emergency_stop());
  EXPECT_FALSE(fixture.safety.release_emergency_stop());
  fixture.run(1.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
  ASSERT_TRUE(fixture.safety.brake_release());
  fixture.until([&] { return fixture.state.robot_mode == RobotMode::running; }, 5.0);
}

TEST(EmergencyStopTest, SystemEmergencyStopHasItsOwnMode)
{
  RobotFixture fixture;
  fixture.safety.press_emergency_stop(true);
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::system_emergency_stop);
}

TEST(EmergencyStopTest, CutsThePowerEvenIfReleasedDuringTheStop)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  fixture.run(0.5);
  fixture.safety.press_emergency_stop();
  fixture.step();
  ASSERT_TRUE(fixture.safety.release_emergency_stop());
  fixture.until([&] { return fixture.state.robot_mode == RobotMode::power_off; }, 1.0);
}

TEST(SafeguardTest, PausesAndResumesTheProgram)
{
  RobotFixture fixture;
  fixture.state.runtime_state = RuntimeState::playing;
  fixture.step();
  fixture.safety.open_safeguard();
  fixture.run(0.1);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::safeguard_stop);
  EXPECT_EQ(fixture.paused, 1);
  EXPECT_FALSE(fixture.safety.unlock_protective_stop());
  ASSERT_TRUE(fixture.safety.reset_safeguard());
  fixture.step();
  EXPECT_EQ(fixture.resumed, 1);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
  EXPECT_FALSE(fixture.safety.reset_safeguard());
}

TEST(SafeguardTest, DoesNotResumeAProgramThatItHasNotPaused)
{
  RobotFixture fixture;
  fixture.state.runtime_state = RuntimeState::paused;
  fixture.step();
  fixture.safety.open_safeguard();
  fixture.run(0.1);
  ASSERT_TRUE(fixture.safety.reset_safeguard());
  fixture.step();
  EXPECT_EQ(fixture.resumed, 0);
}

TEST(ReducedModeTest, IsRestoredAfterAStop)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.safety.set_reduced(true));
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::reduced);
  fixture.safety.trigger_protective_stop("test");
  fixture.run(5.1);
  ASSERT_TRUE(fixture.safety.unlock_protective_stop());
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::reduced);
}

TEST(SafetyViolationTest, EndsOnlyByRestartingTheSafetySystem)
{
  for (const bool fault : {false, true}) {
    RobotFixture fixture;
    fixture.step();
    fault ? fixture.safety.trigger_fault("joint encoder") : fixture.safety.trigger_violation("joint speed");
    fixture.run(1.0);
    EXPECT_EQ(fixture.state.safety_mode, fault ? SafetyMode::fault : SafetyMode::violation);
    EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
    EXPECT_FALSE(fixture.safety.power_on());
    ASSERT_TRUE(fixture.safety.restart_safety());
    fixture.run(2.6);
    EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
    EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
    ASSERT_TRUE(fixture.safety.brake_release());
    fixture.until([&] { return fixture.state.robot_mode == RobotMode::running; }, 5.0);
  }
}

TEST(RestartSafetyTest, DuringAMotionStopsBeforeItCutsThePower)
{
  RobotFixture fixture;
  ASSERT_TRUE(fixture.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  fixture.run(0.5);
  ASSERT_TRUE(fixture.safety.restart_safety());
  fixture.step();
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::running);
  fixture.until([&] { return fixture.state.robot_mode == RobotMode::power_off; }, 0.3);
}

TEST(RestartSafetyTest, PowersOnAfterRestartIfRequestedMeanwhile)
{
  RobotFixture fixture;
  fixture.step();
  fixture.safety.trigger_violation("joint speed");
  fixture.run(1.0);
  ASSERT_TRUE(fixture.safety.restart_safety());
  EXPECT_TRUE(fixture.safety.power_on());
  fixture.run(2.4);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
  fixture.until([&] { return fixture.state.robot_mode == RobotMode::idle; }, 2.0);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
}

TEST(RestartSafetyTest, EndsInEmergencyStopIfTheButtonIsPressedMeanwhile)
{
  RobotFixture fixture;
  fixture.step();
  fixture.safety.trigger_violation("joint speed");
  fixture.run(1.0);
  ASSERT_TRUE(fixture.safety.restart_safety());
  ASSERT_TRUE(fixture.safety.power_on());
  fixture.safety.press_emergency_stop(false);
  fixture.run(2.6);
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::robot_emergency_stop);
  EXPECT_EQ(fixture.state.robot_mode, RobotMode::power_off);
  ASSERT_TRUE(fixture.safety.release_emergency_stop());
  fixture.step();
  EXPECT_EQ(fixture.state.safety_mode, SafetyMode::normal);
}

TEST(SteadyTest, IsTrueAfterHalfASecondAtStandstill)
{
  RobotFixture fixture;
  fixture.run(0.1);
  EXPECT_TRUE(fixture.state.steady);
  ASSERT_TRUE(fixture.arm.speed_joint(six(0.2, 0, 0, 0, 0, 0), 5.0, 0.0));
  fixture.run(0.2);
  EXPECT_FALSE(fixture.state.steady);
  ASSERT_TRUE(fixture.arm.stop_joint(5.0));
  fixture.until([&] { return fixture.arm.at_rest(); }, 1.0);
  EXPECT_FALSE(fixture.state.steady);
  EXPECT_NEAR(fixture.until([&] { return fixture.state.steady; }, 1.0), 0.5, 0.05);
}

TEST(StatusBitsTest, MatchTheRtdeGuide)
{
  EXPECT_EQ(robot_status_bits(RobotMode::running, RuntimeState::playing, false), 0b011u);
  EXPECT_EQ(robot_status_bits(RobotMode::idle, RuntimeState::stopped, true), 0b101u);
  EXPECT_EQ(robot_status_bits(RobotMode::power_off, RuntimeState::stopped, false), 0u);
  EXPECT_EQ(safety_status_bits(SafetyMode::normal), 1u);
  EXPECT_EQ(safety_status_bits(SafetyMode::reduced), 1u << 1);
  EXPECT_EQ(safety_status_bits(SafetyMode::protective_stop), (1u << 2) | (1u << 10));
  EXPECT_EQ(safety_status_bits(SafetyMode::safeguard_stop), (1u << 4) | (1u << 10));
  EXPECT_EQ(safety_status_bits(SafetyMode::robot_emergency_stop), (1u << 6) | (1u << 7) | (1u << 10));
  EXPECT_EQ(safety_status_bits(SafetyMode::fault), (1u << 9) | (1u << 10));
}

TEST(StatusBitsTest, FollowTheModesInTheState)
{
  RobotFixture fixture;
  fixture.state.runtime_state = RuntimeState::playing;
  fixture.step();
  EXPECT_EQ(fixture.state.robot_status_bits, 0b011u);
  EXPECT_EQ(fixture.state.safety_status_bits, 1u);
  fixture.safety.trigger_protective_stop("test");
  fixture.step();
  EXPECT_EQ(fixture.state.safety_status_bits, (1u << 2) | (1u << 10));
}

TEST(SafetyEventTest, QueueIsBoundedAndCountsDroppedEvents)
{
  RobotFixture fixture;
  fixture.step();
  for (int i = 0; i < 1000; ++i) {
    fixture.safety.trigger_protective_stop("again");
  }
  int kept = 0;
  while (fixture.safety.take_event()) {
    ++kept;
  }
  EXPECT_EQ(kept, 256);
  EXPECT_GT(fixture.safety.dropped_events(), 700u);
}

TEST(SafetyEventTest, ContainsTimeAndModes)
{
  RobotFixture fixture;
  while (fixture.safety.take_event()) {
  }
  fixture.run(1.0);
  fixture.safety.trigger_protective_stop("test");
  fixture.step();
  bool found = false;
  while (const auto event = fixture.safety.take_event()) {
    found = found ||
            (event->level == SafetyEvent::Level::error && event->safety_mode == SafetyMode::protective_stop &&
             std::abs(event->timestamp - 1.0) < 0.01);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace ur_simulator
