#include "program/program_state_machine.hpp"

#include <array>

namespace ur_ros_rtde {
namespace program_table {

// Short names for the columns of the table.
using S = ProgramState;
using E = ProgramEvent;
using G = ProgramGuard;
using A = ProgramAction;

constexpr auto transitions = std::to_array<ProgramTransition>({
    // The RTDE connection of the samples.
    {S::disconnected, E::link_established, G::always, S::unclaimed, A::none},
    {S::program_lost, E::link_established, G::always, S::orphaned, A::none},
    {S::unclaimed, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    {S::orphaned, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    {S::starting, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    {S::running, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    {S::yielding, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    {S::yielded, E::link_lost, G::always, S::yielded, A::close_interfaces},
    {S::resuming, E::link_lost, G::stopped, S::disconnected, A::close_interfaces},
    {S::resuming, E::link_lost, G::not_stopped, S::program_lost, A::close_interfaces},
    {S::ended, E::link_lost, G::stopped, S::disconnected, A::close_interfaces},
    {S::ended, E::link_lost, G::not_stopped, S::program_lost, A::close_interfaces},
    {S::idle, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    {S::foreign, E::link_lost, G::always, S::foreign, A::close_interfaces},
    {S::restarting, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    {S::restart_failed, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    {S::in_use, E::link_lost, G::always, S::in_use, A::close_interfaces},
    {S::in_use_after_end, E::link_lost, G::always, S::in_use, A::close_interfaces},

    // The control program has not run since the connection was established.
    {S::unclaimed, E::sample, G::urcap | G::stopped, S::idle, A::none},
    {S::unclaimed, E::robot_ready, G::upload | G::remote | G::stopped, S::starting, A::start_program},
    {S::unclaimed, E::robot_ready, G::upload | G::remote | G::not_stopped, S::unclaimed, A::stop_program},
    {S::unclaimed, E::inputs_in_use, G::upload, S::in_use, A::close_interfaces},
    {S::orphaned, E::sample, G::urcap | G::stopped, S::idle, A::none},
    {S::orphaned, E::sample, G::upload | G::stopped, S::unclaimed, A::none},
    {S::orphaned, E::robot_ready, G::upload | G::remote | G::not_stopped, S::orphaned, A::stop_program},
    {S::orphaned, E::robot_ready, G::urcap | G::playing, S::orphaned, A::stop_program},
    {S::orphaned, E::inspection, G::paused, S::orphaned, A::stop_program},
    {S::orphaned, E::inputs_in_use, G::upload, S::in_use, A::close_interfaces},

    // The start.
    {S::starting, E::program_started, G::always, S::running, A::none},
    {S::starting, E::start_failed, G::always, S::unclaimed, A::none},
    {S::starting, E::start_aborted, G::always, S::unclaimed, A::none},
    {S::starting, E::inputs_in_use, G::always, S::in_use, A::close_interfaces},

    // The control program runs.
    {S::running, E::control_link_lost, G::always, S::orphaned, A::close_control},
    {S::running, E::sample, G::stopped, S::idle, A::close_control},
    {S::running, E::sample, G::paused, S::ended, A::close_control},
    {S::running, E::heartbeat_lost, G::always, S::foreign, A::close_control},

    // A script runs in its place.
    {S::running, E::yield_requested, G::upload, S::yielding, A::suspend_program},
    {S::yielding, E::yield_rejected, G::always, S::running, A::none},
    {S::yielding, E::heartbeat_lost, G::always, S::foreign, A::close_control},
    {S::yielding, E::yield_failed, G::stopped, S::idle, A::close_control},
    {S::yielding, E::yield_failed, G::paused, S::ended, A::close_control},
    {S::yielding, E::yield_failed, G::playing, S::orphaned, A::close_control},
    {S::yielding, E::yield_canceled, G::always, S::orphaned, A::close_control},
    {S::yielding, E::program_yielded, G::always, S::yielded, A::none},
    {S::yielded, E::resume_requested, G::always, S::resuming, A::none},
    {S::yielded, E::script_replaced, G::stopped, S::idle, A::close_control},
    {S::yielded, E::script_replaced, G::not_stopped, S::foreign, A::close_control},
    {S::resuming, E::robot_ready, G::remote | G::stopped, S::resuming, A::start_program},
    {S::resuming, E::robot_ready, G::remote | G::not_stopped, S::resuming, A::stop_program},
    {S::resuming, E::program_started, G::always, S::running, A::none},
    {S::resuming, E::start_failed, G::always, S::unclaimed, A::none},
    {S::resuming, E::start_aborted, G::always, S::unclaimed, A::none},
    {S::resuming, E::resume_blocked, G::stopped, S::unclaimed, A::none},
    {S::resuming, E::resume_blocked, G::not_stopped, S::orphaned, A::close_control},
    {S::resuming, E::inputs_in_use, G::always, S::in_use, A::close_interfaces},

    // The control program has ended.
    {S::ended, E::sample, G::stopped, S::idle, A::none},
    {S::ended, E::sample, G::playing, S::foreign, A::none},
    {S::ended, E::inspection, G::paused, S::ended, A::stop_program},
    {S::idle, E::sample, G::upload | G::not_stopped, S::foreign, A::none},
    {S::idle, E::robot_ready, G::upload | G::restart | G::remote | G::stopped, S::restarting,
     A::start_program},
    {S::idle, E::inputs_in_use, G::upload, S::in_use_after_end, A::close_interfaces},
    {S::foreign, E::sample, G::stopped, S::idle, A::none},
    {S::foreign, E::inputs_in_use, G::upload, S::in_use_after_end, A::close_interfaces},

    // The restart.
    {S::restarting, E::program_started, G::always, S::running, A::none},
    {S::restarting, E::start_failed, G::always, S::restart_failed, A::none},
    {S::restarting, E::start_aborted, G::always, S::idle, A::none},
    {S::restarting, E::inputs_in_use, G::always, S::in_use_after_end, A::close_interfaces},
    {S::restart_failed, E::inspection, G::stopped, S::idle, A::none},
    {S::restart_failed, E::robot_ready, G::remote | G::not_stopped, S::restart_failed, A::stop_program},
    {S::restart_failed, E::inputs_in_use, G::always, S::in_use_after_end, A::close_interfaces},

    // The External Control URCap fetches the control program; the operator starts it.
    {S::idle, E::robot_ready, G::urcap | G::stopped, S::idle, A::connect_control},
    {S::idle, E::robot_ready, G::urcap | G::playing, S::idle, A::adopt_program},
    {S::idle, E::program_adopted, G::urcap, S::running, A::none},

    // Another driver has the robot, or has left its program.
    {S::in_use, E::robot_ready, G::remote | G::stopped, S::starting, A::start_program},
    {S::in_use, E::robot_ready, G::not_stopped, S::in_use, A::close_interfaces},
    {S::in_use_after_end, E::robot_ready, G::restart | G::remote | G::stopped, S::restarting,
     A::start_program},
    {S::in_use_after_end, E::robot_ready, G::no_restart | G::stopped, S::idle, A::none},
    {S::in_use_after_end, E::robot_ready, G::not_stopped, S::in_use_after_end, A::close_interfaces},
});

}  // namespace program_table

namespace {

struct ConditionName {
  ProgramGuard::Condition condition;
  const char * name;
};

constexpr std::array condition_names{
    ConditionName{ProgramGuard::upload, "upload"},
    ConditionName{ProgramGuard::urcap, "control_urcap"},
    ConditionName{ProgramGuard::restart, "restart_program"},
    ConditionName{ProgramGuard::no_restart, "no restart_program"},
    ConditionName{ProgramGuard::remote, "remote control"},
    ConditionName{ProgramGuard::stopped, "stopped"},
    ConditionName{ProgramGuard::paused, "paused"},
    ConditionName{ProgramGuard::playing, "playing"},
    ConditionName{ProgramGuard::not_stopped, "not stopped"},
};

}  // namespace

std::span<const ProgramTransition> program_transitions()
{
  return program_table::transitions;
}

ProgramActivity program_activity(RuntimeState state)
{
  switch (state) {
    case RuntimeState::stopped:
      return ProgramActivity::stopped;
    case RuntimeState::playing:
      return ProgramActivity::playing;
    default:
      return ProgramActivity::paused;
  }
}

bool is_pause(RuntimeState state)
{
  return state == RuntimeState::pausing || state == RuntimeState::paused;
}

bool ProgramStateMachine::allows(ProgramGuard guard, const ProgramObservation & observation) const
{
  const bool stopped = observation.program == ProgramActivity::stopped;
  const unsigned met =
      static_cast<unsigned>(mode_ == ControlMode::upload ? ProgramGuard::upload : ProgramGuard::urcap) |
      static_cast<unsigned>(restart_program_ ? ProgramGuard::restart : ProgramGuard::no_restart) |
      static_cast<unsigned>(observation.remote_control ? ProgramGuard::remote : ProgramGuard::always) |
      static_cast<unsigned>(stopped ? ProgramGuard::stopped : ProgramGuard::not_stopped) |
      static_cast<unsigned>(observation.program == ProgramActivity::paused ? ProgramGuard::paused
                                                                           : ProgramGuard::always) |
      static_cast<unsigned>(observation.program == ProgramActivity::playing ? ProgramGuard::playing
                                                                            : ProgramGuard::always);
  return (guard.conditions & ~met) == 0;
}

ProgramAction ProgramStateMachine::process(ProgramEvent event, const ProgramObservation & observation)
{
  for (const auto & transition : program_table::transitions) {
    if (transition.from == state_ && transition.event == event && allows(transition.guard, observation)) {
      state_ = transition.to;
      return transition.action;
    }
  }
  return ProgramAction::none;
}

const char * to_string(ProgramState state)
{
  switch (state) {
    case ProgramState::disconnected:
      return "disconnected";
    case ProgramState::program_lost:
      return "program_lost";
    case ProgramState::unclaimed:
      return "unclaimed";
    case ProgramState::orphaned:
      return "orphaned";
    case ProgramState::starting:
      return "starting";
    case ProgramState::running:
      return "running";
    case ProgramState::yielding:
      return "yielding";
    case ProgramState::yielded:
      return "yielded";
    case ProgramState::resuming:
      return "resuming";
    case ProgramState::ended:
      return "ended";
    case ProgramState::idle:
      return "idle";
    case ProgramState::foreign:
      return "foreign";
    case ProgramState::restarting:
      return "restarting";
    case ProgramState::restart_failed:
      return "restart_failed";
    case ProgramState::in_use:
      return "in_use";
    case ProgramState::in_use_after_end:
      return "in_use_after_end";
  }
  return "unknown";
}

const char * to_string(ProgramEvent event)
{
  switch (event) {
    case ProgramEvent::link_established:
      return "link_established";
    case ProgramEvent::link_lost:
      return "link_lost";
    case ProgramEvent::control_link_lost:
      return "control_link_lost";
    case ProgramEvent::sample:
      return "sample";
    case ProgramEvent::heartbeat_lost:
      return "heartbeat_lost";
    case ProgramEvent::inspection:
      return "inspection";
    case ProgramEvent::robot_ready:
      return "robot_ready";
    case ProgramEvent::program_started:
      return "program_started";
    case ProgramEvent::start_failed:
      return "start_failed";
    case ProgramEvent::start_aborted:
      return "start_aborted";
    case ProgramEvent::program_adopted:
      return "program_adopted";
    case ProgramEvent::inputs_in_use:
      return "inputs_in_use";
    case ProgramEvent::yield_requested:
      return "yield_requested";
    case ProgramEvent::yield_rejected:
      return "yield_rejected";
    case ProgramEvent::yield_failed:
      return "yield_failed";
    case ProgramEvent::yield_canceled:
      return "yield_canceled";
    case ProgramEvent::program_yielded:
      return "program_yielded";
    case ProgramEvent::resume_requested:
      return "resume_requested";
    case ProgramEvent::resume_blocked:
      return "resume_blocked";
    case ProgramEvent::script_replaced:
      return "script_replaced";
  }
  return "unknown";
}

const char * to_string(ProgramAction action)
{
  switch (action) {
    case ProgramAction::none:
      return "none";
    case ProgramAction::close_control:
      return "close_control";
    case ProgramAction::close_interfaces:
      return "close_interfaces";
    case ProgramAction::stop_program:
      return "stop_program";
    case ProgramAction::start_program:
      return "start_program";
    case ProgramAction::connect_control:
      return "connect_control";
    case ProgramAction::adopt_program:
      return "adopt_program";
    case ProgramAction::suspend_program:
      return "suspend_program";
  }
  return "unknown";
}

std::string to_string(ProgramGuard guard)
{
  std::string text;
  for (const auto & [condition, name] : condition_names) {
    if ((guard.conditions & condition) != 0) {
      text += (text.empty() ? "" : ", ") + std::string(name);
    }
  }
  return text;
}

}  // namespace ur_ros_rtde
