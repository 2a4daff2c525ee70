#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

#include "program/program_state_machine.hpp"

namespace ur_ros_rtde::test {
namespace {

using S = ProgramState;
using E = ProgramEvent;
using A = ProgramAction;
using G = ProgramGuard;

/// Everything that a guard can depend on.
struct Context {
  ControlMode mode = ControlMode::upload;
  bool restart = true;
  ProgramObservation observation;
};

std::vector<Context> all_contexts()
{
  std::vector<Context> contexts;
  for (const auto mode : {ControlMode::upload, ControlMode::control_urcap}) {
    for (const bool restart : {true, false}) {
      for (const auto program :
           {ProgramActivity::stopped, ProgramActivity::paused, ProgramActivity::playing}) {
        for (const bool remote : {true, false}) {
          contexts.push_back({mode, restart, {program, remote}});
        }
      }
    }
  }
  return contexts;
}

template <class T>
std::vector<T> all(std::size_t count)
{
  std::vector<T> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<T>(i));
  }
  return values;
}

const auto all_states = all<S>(program_state_count);
const auto all_events = all<E>(program_event_count);

/// The meaning of the guards, stated independently of the implementation.
bool is_met(ProgramGuard guard, const Context & context)
{
  const std::map<G::Condition, bool> met{
      {G::upload, context.mode == ControlMode::upload},
      {G::urcap, context.mode == ControlMode::control_urcap},
      {G::restart, context.restart},
      {G::no_restart, !context.restart},
      {G::remote, context.observation.remote_control},
      {G::stopped, context.observation.program == ProgramActivity::stopped},
      {G::paused, context.observation.program == ProgramActivity::paused},
      {G::playing, context.observation.program == ProgramActivity::playing},
      {G::not_stopped, context.observation.program != ProgramActivity::stopped},
  };
  for (const auto & [condition, value] : met) {
    if ((guard.conditions & condition) != 0 && !value) {
      return false;
    }
  }
  return true;
}

std::vector<ProgramTransition> matching(S state, E event, const Context & context)
{
  std::vector<ProgramTransition> result;
  for (const auto & transition : program_transitions()) {
    if (transition.from == state && transition.event == event && is_met(transition.guard, context)) {
      result.push_back(transition);
    }
  }
  return result;
}

std::string describe(const ProgramTransition & transition)
{
  return std::string(to_string(transition.from)) + ", " + to_string(transition.event) + " [" +
         to_string(transition.guard) + "]";
}

TEST(ProgramStateMachineTest, FollowsEachRowOfTheTable)
{
  for (const auto & transition : program_transitions()) {
    bool tested = false;
    for (const auto & context : all_contexts()) {
      if (!is_met(transition.guard, context)) {
        continue;
      }
      tested = true;
      ProgramStateMachine machine(context.mode, context.restart, transition.from);
      EXPECT_EQ(machine.process(transition.event, context.observation), transition.action)
          << describe(transition);
      EXPECT_EQ(machine.state(), transition.to) << describe(transition);
    }
    EXPECT_TRUE(tested) << "contradictory guard: " << describe(transition);
  }
}

TEST(ProgramStateMachineTest, HasAtMostOneTransitionForEachSituation)
{
  for (const auto state : all_states) {
    for (const auto event : all_events) {
      for (const auto & context : all_contexts()) {
        const auto transitions = matching(state, event, context);
        EXPECT_LE(transitions.size(), 1U) << describe(transitions.front());
      }
    }
  }
}

TEST(ProgramStateMachineTest, IgnoresEventsThatAreNotInTheTable)
{
  std::size_t ignored = 0;
  for (const auto state : all_states) {
    for (const auto event : all_events) {
      for (const auto & context : all_contexts()) {
        if (!matching(state, event, context).empty()) {
          continue;
        }
        ++ignored;
        ProgramStateMachine machine(context.mode, context.restart, state);
        EXPECT_EQ(machine.process(event, context.observation), A::none)
            << to_string(state) << ", " << to_string(event);
        EXPECT_EQ(machine.state(), state) << to_string(state) << ", " << to_string(event);
      }
    }
  }
  EXPECT_GT(ignored, 0U);
}

TEST(ProgramStateMachineTest, NamesEveryStateEventAndAction)
{
  const std::string unknown = "unknown";
  EXPECT_EQ(to_string(static_cast<S>(program_state_count)), unknown) << "program_state_count is too small";
  EXPECT_EQ(to_string(static_cast<E>(program_event_count)), unknown) << "program_event_count is too small";
  EXPECT_EQ(to_string(static_cast<A>(program_action_count)), unknown) << "program_action_count is too small";
  EXPECT_NE(to_string(all_states.back()), unknown);
  EXPECT_NE(to_string(all_events.back()), unknown);
  EXPECT_NE(to_string(static_cast<A>(program_action_count - 1)), unknown);
}

/// Every state that some sequence of events leads to.
std::set<S> reachable(ControlMode mode, bool restart)
{
  std::set<S> found{S::disconnected};
  for (std::size_t before = 0; before != found.size();) {
    before = found.size();
    for (const auto & context : all_contexts()) {
      if (context.mode != mode || context.restart != restart) {
        continue;
      }
      for (const auto state : std::set<S>(found)) {
        for (const auto event : all_events) {
          ProgramStateMachine machine(mode, restart, state);
          machine.process(event, context.observation);
          found.insert(machine.state());
        }
      }
    }
  }
  return found;
}

TEST(ProgramStateMachineTest, ReachesEveryStateWhenProgramsAreUploaded)
{
  const std::set<S> expected(all_states.begin(), all_states.end());
  EXPECT_EQ(reachable(ControlMode::upload, true), expected);
}

TEST(ProgramStateMachineTest, NeverRestartsWhenRestartingIsOff)
{
  auto expected = std::set<S>(all_states.begin(), all_states.end());
  expected.erase(S::restarting);
  expected.erase(S::restart_failed);
  EXPECT_EQ(reachable(ControlMode::upload, false), expected);
}

TEST(ProgramStateMachineTest, NeverStartsAProgramThatTheUrcapFetches)
{
  const std::set<S> expected{S::disconnected, S::program_lost, S::unclaimed, S::orphaned,
                             S::running,      S::ended,        S::idle,      S::foreign};
  for (const bool restart : {true, false}) {
    EXPECT_EQ(reachable(ControlMode::control_urcap, restart), expected);
  }
}

TEST(ProgramStateMachineTest, LeavesEveryState)
{
  for (const auto mode : {ControlMode::upload, ControlMode::control_urcap}) {
    for (const auto state : reachable(mode, true)) {
      bool left = false;
      for (const auto & transition : program_transitions()) {
        left = left || (transition.from == state && transition.to != state);
      }
      EXPECT_TRUE(left) << to_string(state);
    }
  }
}

/// The states in which the action may be requested.
std::set<S> states_that_request(A action)
{
  std::set<S> states;
  for (const auto & transition : program_transitions()) {
    if (transition.action == action) {
      states.insert(transition.from);
    }
  }
  return states;
}

TEST(ProgramStateMachineTest, NeverStopsAForeignProgram)
{
  EXPECT_EQ(states_that_request(A::stop_program),
            (std::set<S>{S::unclaimed, S::orphaned, S::resuming, S::ended, S::restart_failed}));
}

TEST(ProgramStateMachineTest, StopsOnlyProgramsThatAreOnTheRobot)
{
  for (const auto & transition : program_transitions()) {
    if (transition.action == A::stop_program) {
      EXPECT_FALSE(is_met(transition.guard, {ControlMode::upload, true, {ProgramActivity::stopped, true}}));
      EXPECT_FALSE(
          is_met(transition.guard, {ControlMode::control_urcap, true, {ProgramActivity::stopped, true}}));
      EXPECT_EQ(transition.from, transition.to) << "the samples have to show that it has stopped";
    }
  }
}

TEST(ProgramStateMachineTest, UploadsOnlyToAStoppedRobotInRemoteControl)
{
  for (const auto & transition : program_transitions()) {
    if (transition.action == A::start_program) {
      EXPECT_NE(transition.guard.conditions & G::remote, 0) << describe(transition);
      EXPECT_NE(transition.guard.conditions & G::stopped, 0) << describe(transition);
    }
  }
}

/// A program that begins after the control program has ended is foreign until the robot has stopped it, or
/// the control program has failed to restart; and if this has not been noticed, until the connection is lost.
TEST(ProgramStateMachineTest, LeavesAProgramAloneThatReplacedTheControlProgram)
{
  struct Situation {
    S state;
    bool replaced;  ///< the program on the robot has replaced the control program
    auto operator<=>(const Situation &) const = default;
  };
  std::set<Situation> found{{S::running, false}};
  const auto contexts = all_contexts();
  for (std::size_t before = 0; before != found.size();) {
    before = found.size();
    for (const auto & [state, replaced] : std::set<Situation>(found)) {
      for (const auto event : all_events) {
        for (const auto & context : contexts) {
          if (context.mode != ControlMode::upload || (replaced && event == E::program_started)) {
            continue;  // it would not be the one that replaced the control program
          }
          ProgramStateMachine machine(context.mode, context.restart, state);
          const auto action = machine.process(event, context.observation);
          const bool on_robot = context.observation.program != ProgramActivity::stopped;
          if (replaced && on_robot) {
            EXPECT_NE(action, A::stop_program) << to_string(state) << ", " << to_string(event);
            EXPECT_NE(action, A::start_program) << to_string(state) << ", " << to_string(event);
          }
          const bool keeps = event != E::link_lost || state == S::foreign;
          const bool noticed =
              ((state == S::running || state == S::yielding) && event == E::heartbeat_lost) ||
              (state == S::yielded && event == E::script_replaced);
          if (keeps && on_robot) {
            found.insert({machine.state(), replaced || noticed});
          } else {
            found.insert({machine.state(), false});
          }
        }
      }
    }
  }
  EXPECT_TRUE(found.contains({S::foreign, true}));
  EXPECT_TRUE(found.contains({S::in_use_after_end, true}));
}

}  // namespace
}  // namespace ur_ros_rtde::test
