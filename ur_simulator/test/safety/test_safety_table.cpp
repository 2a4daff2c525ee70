// Each safety mode × each event. The modes and their recoveries are those of the user manuals ("Safety
// modes", "Stop categories", "Safeguard stop"); that the safeguard is an input with memory is what its wiring
// makes it.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "support/robot_fixture.hpp"

namespace ur_simulator {
namespace {

using testing::RobotFixture;

enum class Event {
  protective_stop,
  unlock,
  open_safeguard,
  close_safeguard,
  press_button,
  release_button,
  press_system_button,
  reduce,
  restart,
  violation,
  fault,
};
constexpr std::size_t event_count = 11;

/// What happened before: the events that lead to the mode.
struct Row {
  const char * name;
  std::vector<Event> history;
  SafetyMode mode;
  std::array<SafetyMode, event_count> after;  ///< in the order of Event
};

constexpr auto N = SafetyMode::normal;
constexpr auto R = SafetyMode::reduced;
constexpr auto P = SafetyMode::protective_stop;
constexpr auto G = SafetyMode::safeguard_stop;
constexpr auto E = SafetyMode::robot_emergency_stop;
constexpr auto S = SafetyMode::system_emergency_stop;
constexpr auto V = SafetyMode::violation;
constexpr auto F = SafetyMode::fault;

const std::vector<Row> table{
    // history                                                  protective, unlock, open, close, press,
    // release,
    //                                                          system, reduce, restart, violation, fault
    {"normal", {}, N, {P, N, G, N, E, N, S, R, N, V, F}},
    {"reduced", {Event::reduce}, R, {P, R, G, R, E, R, S, R, R, V, F}},
    {"protective", {Event::protective_stop}, P, {P, N, P, P, E, P, S, P, N, V, F}},
    {"safeguard", {Event::open_safeguard}, G, {G, G, G, N, E, G, S, G, G, V, F}},
    {"protective_and_safeguard",
     {Event::protective_stop, Event::open_safeguard},
     P,
     {P, G, P, P, E, P, S, P, G, V, F}},
    {"reduced_and_safeguard", {Event::reduce, Event::open_safeguard}, G, {G, G, G, R, E, G, S, G, G, V, F}},
    {"emergency", {Event::press_button}, E, {E, E, E, E, E, N, S, E, E, V, F}},
    {"system_emergency", {Event::press_system_button}, S, {S, S, S, S, E, N, S, S, S, V, F}},
    {"emergency_and_safeguard",
     {Event::open_safeguard, Event::press_button},
     E,
     {E, E, E, E, E, G, S, E, E, V, F}},
    {"violation", {Event::violation}, V, {V, V, V, V, V, V, V, V, N, V, F}},
    {"violation_and_safeguard",
     {Event::violation, Event::open_safeguard},
     V,
     {V, V, V, V, V, V, V, V, G, V, F}},
    {"fault", {Event::fault}, F, {F, F, F, F, F, F, F, F, N, V, F}},
};

void apply(RobotFixture & robot, Event event)
{
  switch (event) {
    case Event::protective_stop:
      return robot.safety.trigger_protective_stop("test");
    case Event::unlock:
      static_cast<void>(robot.safety.unlock_protective_stop(UnlockDelay::waived));
      return;
    case Event::open_safeguard:
      return robot.safety.open_safeguard();
    case Event::close_safeguard:
      static_cast<void>(robot.safety.reset_safeguard());
      return;
    case Event::press_button:
      return robot.safety.press_emergency_stop();
    case Event::release_button:
      static_cast<void>(robot.safety.release_emergency_stop());
      return;
    case Event::press_system_button:
      return robot.safety.press_emergency_stop(true);
    case Event::reduce:
      static_cast<void>(robot.safety.set_reduced(true));
      return;
    case Event::restart:
      static_cast<void>(robot.safety.restart_safety());
      return;
    case Event::violation:
      return robot.safety.trigger_violation("test");
    case Event::fault:
      return robot.safety.trigger_fault("test");
  }
}

class SafetyTableTest : public ::testing::TestWithParam<Row> {};

TEST_P(SafetyTableTest, EachEventLeadsToTheModeOfTheTable)
{
  const Row & row = GetParam();
  for (std::size_t event = 0; event < event_count; ++event) {
    RobotFixture robot;
    for (const Event before : row.history) {
      apply(robot, before);
      robot.run(0.1);
    }
    ASSERT_EQ(robot.state.safety_mode, row.mode);
    apply(robot, static_cast<Event>(event));
    robot.until([&] { return !robot.safety.restarting(); }, 30.0);
    EXPECT_EQ(robot.state.safety_mode, row.after[event]) << "after event " << event << "\n" << robot.log();
  }
}

INSTANTIATE_TEST_SUITE_P(All, SafetyTableTest, ::testing::ValuesIn(table),
                         [](const auto & tested) { return std::string(tested.param.name); });

/// A reboot does not change what is wired to the robot.
TEST(SafetyInputsTest, ASafetySystemBeginsInTheModeOfItsInputs)
{
  const RobotFixture robot;
  const auto mode = [&](const SafetyInputs & inputs) {
    ControllerState state;
    Safety(robot.model, robot.dt, {}, {}, inputs).write(state);
    return state.safety_mode;
  };
  EXPECT_EQ(mode({}), N);
  EXPECT_EQ(mode({.reduced = true}), R);
  EXPECT_EQ(mode({.safeguard_open = true, .reduced = true}), G);
  EXPECT_EQ(mode({.emergency_stop = S, .safeguard_open = true}), S);
}

/// The control port's shortcut, too.
TEST(SafetyInputsTest, AnArmIsNotPoweredDuringAnEmergencyStop)
{
  RobotFixture robot;
  robot.safety.press_emergency_stop();
  robot.run(2.0);
  EXPECT_FALSE(robot.safety.start_running(robot.state));
  EXPECT_EQ(robot.state.robot_mode, RobotMode::power_off);
}

}  // namespace
}  // namespace ur_simulator
