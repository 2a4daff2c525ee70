#include <gtest/gtest.h>

#include <vector>

#include "whole_rig.hpp"

namespace ur_simulator {
namespace {

using testing::six;
using testing::WholeRig;

constexpr auto power_off_first = false;

TEST(Power, comes_up_through_booting_and_idle_and_takes_its_time)
{
  WholeRig rig("ur10e", {}, power_off_first);
  rig.run(0.1);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::power_off);
  ASSERT_TRUE(rig.safety.power_on());
  std::vector<RobotMode> seen;
  const double time = rig.until(
      [&] {
        if (seen.empty() || seen.back() != rig.state.robot_mode) {
          seen.push_back(rig.state.robot_mode);
        }
        return rig.state.robot_mode == RobotMode::idle;
      },
      5.0);
  EXPECT_EQ(seen,
            (std::vector{RobotMode::power_off, RobotMode::booting, RobotMode::power_on, RobotMode::idle}));
  EXPECT_NEAR(time, 1.5, 0.02);
  rig.run(5.0);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::idle);
  EXPECT_EQ(rig.state.joint_modes[0], 255);
  ASSERT_TRUE(rig.safety.brake_release());
  EXPECT_NEAR(rig.until([&] { return rig.state.robot_mode == RobotMode::running; }, 5.0), 1.0, 0.02);
  EXPECT_EQ(rig.state.joint_modes[5], 253);
}

TEST(Power, brake_release_powers_on_first)
{
  WholeRig rig("ur10e", {}, power_off_first);
  ASSERT_TRUE(rig.safety.brake_release());
  rig.until([&] { return rig.state.robot_mode == RobotMode::running; }, 5.0);
}

TEST(Power, delays_are_options)
{
  SafetyTimes times;
  times.power_on = 0.1;
  times.brake_release = 0.05;
  WholeRig rig("ur10e", times, power_off_first);
  ASSERT_TRUE(rig.safety.brake_release());
  EXPECT_LT(rig.until([&] { return rig.state.robot_mode == RobotMode::running; }, 5.0), 0.2);
}

TEST(Power, off_in_the_middle_of_a_motion_brakes_first)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  rig.run(0.5);
  ASSERT_TRUE(rig.safety.power_off());
  double last_speed = rig.state.actual.velocity[0];
  rig.until(
      [&] {
        EXPECT_LE(rig.state.actual.velocity[0], last_speed + 1e-9);
        EXPECT_TRUE(rig.state.robot_mode == RobotMode::running || last_speed < 0.01);
        last_speed = rig.state.actual.velocity[0];
        return rig.state.robot_mode == RobotMode::power_off;
      },
      1.0);
  EXPECT_EQ(rig.stopped, 1);
  rig.run(3.0);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::power_off);
}

TEST(ProtectiveStop, brakes_hard_pauses_the_program_and_keeps_the_power)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(1.0, 0, 0, 0, 0, 0), 5.0, 0.0));
  rig.run(0.5);
  rig.safety.trip("somebody leant on the robot");
  const double time = rig.until([&] { return rig.arm.at_rest(); }, 1.0);
  EXPECT_LT(time, 0.2);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::protective_stop);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::running);
  EXPECT_EQ(rig.paused, 1);
  EXPECT_EQ(rig.stopped, 0);
  EXPECT_NE(rig.log().find("protective stop: somebody leant on the robot"), std::string::npos);
  EXPECT_FALSE(rig.arm.move_joint(default_position(rig.model), {1.4, 1.05}));
}

TEST(ProtectiveStop, cannot_be_unlocked_before_five_seconds_have_passed)
{
  WholeRig rig;
  rig.step();
  rig.safety.trip("test");
  rig.run(4.9);
  const auto early = rig.safety.unlock_protective_stop();
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().find("5 s"), std::string::npos) << early.error();
  rig.run(0.2);
  EXPECT_TRUE(rig.safety.unlock_protective_stop());
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
  EXPECT_TRUE(rig.arm.move_joint(default_position(rig.model), {1.4, 1.05}));
}

TEST(ProtectiveStop, while_stopped_already_is_only_logged)
{
  WholeRig rig;
  rig.step();
  rig.safety.trip("first");
  rig.run(4.0);
  rig.safety.trip("second");
  rig.run(1.5);
  EXPECT_EQ(rig.paused, 1);
  EXPECT_TRUE(rig.safety.unlock_protective_stop());
  EXPECT_NE(rig.log().find("second"), std::string::npos);
}

TEST(ProtectiveStop, does_not_come_without_power)
{
  WholeRig rig("ur10e", {}, power_off_first);
  rig.safety.trip("nobody");
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
  EXPECT_FALSE(rig.safety.unlock_protective_stop());
}

TEST(EmergencyStop, brakes_stops_the_program_and_cuts_the_power_once_the_arm_stands)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  rig.run(0.5);
  rig.safety.press_emergency_stop();
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::robot_emergency_stop);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::running);
  const double time = rig.until([&] { return rig.state.robot_mode == RobotMode::power_off; }, 1.0);
  EXPECT_LT(time, 0.25);
  EXPECT_EQ(rig.stopped, 1);
  EXPECT_EQ(rig.paused, 0);
}

TEST(EmergencyStop, latches_until_released_and_leaves_the_robot_without_power)
{
  WholeRig rig;
  rig.safety.press_emergency_stop();
  rig.run(1.0);
  EXPECT_FALSE(rig.safety.power_on());
  EXPECT_FALSE(rig.safety.brake_release());
  ASSERT_TRUE(rig.safety.release_emergency_stop());
  EXPECT_FALSE(rig.safety.release_emergency_stop());
  rig.run(1.0);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
  EXPECT_EQ(rig.state.robot_mode, RobotMode::power_off);
  ASSERT_TRUE(rig.safety.brake_release());
  rig.until([&] { return rig.state.robot_mode == RobotMode::running; }, 5.0);
}

TEST(EmergencyStop, of_the_system_has_its_own_mode)
{
  WholeRig rig;
  rig.safety.press_emergency_stop(true);
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::system_emergency_stop);
}

TEST(EmergencyStop, released_while_the_arm_still_brakes_cuts_the_power_all_the_same)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  rig.run(0.5);
  rig.safety.press_emergency_stop();
  rig.step();
  ASSERT_TRUE(rig.safety.release_emergency_stop());
  rig.until([&] { return rig.state.robot_mode == RobotMode::power_off; }, 1.0);
}

TEST(Safeguard, pauses_and_resumes_the_program)
{
  WholeRig rig;
  rig.safety.open_safeguard();
  rig.run(0.1);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::safeguard_stop);
  EXPECT_EQ(rig.paused, 1);
  EXPECT_FALSE(rig.safety.unlock_protective_stop());
  ASSERT_TRUE(rig.safety.reset_safeguard());
  rig.step();
  EXPECT_EQ(rig.resumed, 1);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
  EXPECT_FALSE(rig.safety.reset_safeguard());
}

TEST(ReducedMode, is_what_the_robot_goes_back_to_after_a_stop)
{
  WholeRig rig;
  ASSERT_TRUE(rig.safety.set_reduced(true));
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::reduced);
  rig.safety.trip("test");
  rig.run(5.1);
  ASSERT_TRUE(rig.safety.unlock_protective_stop());
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::reduced);
}

TEST(Violation, is_left_by_restarting_the_safety_system_only)
{
  for (const bool fault : {false, true}) {
    WholeRig rig;
    rig.step();
    fault ? rig.safety.fail("joint encoder") : rig.safety.violate("joint speed");
    rig.run(1.0);
    EXPECT_EQ(rig.state.safety_mode, fault ? SafetyMode::fault : SafetyMode::violation);
    EXPECT_EQ(rig.state.robot_mode, RobotMode::power_off);
    EXPECT_FALSE(rig.safety.power_on());
    ASSERT_TRUE(rig.safety.restart_safety());
    rig.run(2.6);
    EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
    EXPECT_EQ(rig.state.robot_mode, RobotMode::power_off);
    ASSERT_TRUE(rig.safety.brake_release());
    rig.until([&] { return rig.state.robot_mode == RobotMode::running; }, 5.0);
  }
}

TEST(RestartSafety, in_the_middle_of_a_motion_brakes_before_it_cuts_the_power)
{
  WholeRig rig;
  ASSERT_TRUE(rig.arm.speed_joint(six(2.0, 0, 0, 0, 0, 0), 10.0, 0.0));
  rig.run(0.5);
  ASSERT_TRUE(rig.safety.restart_safety());
  rig.step();
  EXPECT_EQ(rig.state.robot_mode, RobotMode::running);
  rig.until([&] { return rig.state.robot_mode == RobotMode::power_off; }, 0.3);
  EXPECT_FALSE(rig.safety.power_on());
  rig.run(2.5);
  EXPECT_TRUE(rig.safety.power_on());
}

TEST(RestartSafety, with_the_button_pressed_meanwhile_ends_in_the_emergency_stop)
{
  WholeRig rig;
  rig.step();
  rig.safety.violate("joint speed");
  rig.run(1.0);
  ASSERT_TRUE(rig.safety.restart_safety());
  rig.safety.press_emergency_stop(false);
  rig.run(2.6);
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::robot_emergency_stop);
  ASSERT_TRUE(rig.safety.release_emergency_stop());
  rig.step();
  EXPECT_EQ(rig.state.safety_mode, SafetyMode::normal);
}

TEST(Steady, is_true_only_after_half_a_second_of_standing_still)
{
  WholeRig rig;
  rig.run(0.1);
  EXPECT_TRUE(rig.state.steady);
  ASSERT_TRUE(rig.arm.speed_joint(six(0.2, 0, 0, 0, 0, 0), 5.0, 0.0));
  rig.run(0.2);
  EXPECT_FALSE(rig.state.steady);
  ASSERT_TRUE(rig.arm.stop_joint(5.0));
  rig.until([&] { return rig.arm.at_rest(); }, 1.0);
  EXPECT_FALSE(rig.state.steady);
  EXPECT_NEAR(rig.until([&] { return rig.state.steady; }, 1.0), 0.5, 0.05);
}

TEST(StatusBits, are_those_of_the_rtde_guide)
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

TEST(StatusBits, in_the_state_follow_the_modes)
{
  WholeRig rig;
  rig.state.runtime_state = RuntimeState::playing;
  rig.step();
  EXPECT_EQ(rig.state.robot_status_bits, 0b011u);
  EXPECT_EQ(rig.state.safety_status_bits, 1u);
  rig.safety.trip("test");
  rig.step();
  EXPECT_EQ(rig.state.safety_status_bits, (1u << 2) | (1u << 10));
}

TEST(Events, are_bounded_and_count_what_they_lose)
{
  WholeRig rig;
  rig.step();
  for (int i = 0; i < 1000; ++i) {
    rig.safety.trip("again");
  }
  int kept = 0;
  while (rig.safety.take_event()) {
    ++kept;
  }
  EXPECT_EQ(kept, 256);
  EXPECT_GT(rig.safety.dropped_events(), 700u);
}

TEST(Events, carry_time_and_modes)
{
  WholeRig rig;
  while (rig.safety.take_event()) {
  }
  rig.run(1.0);
  rig.safety.trip("test");
  rig.step();
  bool found = false;
  while (const auto event = rig.safety.take_event()) {
    found = found ||
            (event->level == SafetyEvent::Level::error && event->safety_mode == SafetyMode::protective_stop &&
             std::abs(event->timestamp - 1.0) < 0.01);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace ur_simulator
