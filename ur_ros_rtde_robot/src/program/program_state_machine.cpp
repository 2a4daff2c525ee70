#include "program/program_state_machine.hpp"

#include <array>

namespace ur_ros_rtde {
namespace {

using S = ProgramState;
using E = ProgramEvent;
using A = ProgramAction;
using G = ProgramGuard;

constexpr std::array transitions{
    // The RTDE connection of the samples.
    ProgramTransition{S::disconnected, E::link_established, G::always, S::unclaimed, A::none},
    ProgramTransition{S::program_lost, E::link_established, G::always, S::orphaned, A::none},
    ProgramTransition{S::unclaimed, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::orphaned, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    ProgramTransition{S::starting, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::running, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    ProgramTransition{S::yielding, E::link_lost, G::always, S::program_lost, A::close_interfaces},
    ProgramTransition{S::yielded, E::link_lost, G::always, S::yielded, A::close_interfaces},
    ProgramTransition{S::resuming, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::ended, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::idle, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::foreign, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::restarting, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::restart_failed, E::link_lost, G::always, S::disconnected, A::close_interfaces},
    ProgramTransition{S::in_use, E::link_lost, G::always, S::in_use, A::close_interfaces},
    ProgramTransition{S::in_use_after_end, E::link_lost, G::always, S::in_use, A::close_interfaces},

    // The control program has not run since the connection was established.
    ProgramTransition{S::unclaimed, E::sample, G::urcap | G::stopped, S::idle, A::none},
    ProgramTransition{S::unclaimed, E::robot_ready, G::upload | G::remote | G::stopped, S::starting,
                      A::start_program},
    ProgramTransition{S::unclaimed, E::robot_ready, G::upload | G::remote | G::not_stopped, S::unclaimed,
                      A::stop_program},
    ProgramTransition{S::unclaimed, E::inputs_in_use, G::upload, S::in_use, A::close_interfaces},
    ProgramTransition{S::orphaned, E::sample, G::urcap | G::stopped, S::idle, A::none},
    ProgramTransition{S::orphaned, E::robot_ready, G::upload | G::remote | G::stopped, S::starting,
                      A::start_program},
    ProgramTransition{S::orphaned, E::robot_ready, G::upload | G::remote | G::not_stopped, S::orphaned,
                      A::stop_program},
    ProgramTransition{S::orphaned, E::robot_ready, G::urcap | G::playing, S::orphaned, A::stop_program},
    ProgramTransition{S::orphaned, E::inputs_in_use, G::upload, S::in_use, A::close_interfaces},

    // The start.
    ProgramTransition{S::starting, E::program_started, G::always, S::running, A::none},
    ProgramTransition{S::starting, E::start_failed, G::always, S::unclaimed, A::none},
    ProgramTransition{S::starting, E::start_aborted, G::always, S::unclaimed, A::none},
    ProgramTransition{S::starting, E::inputs_in_use, G::always, S::in_use, A::close_interfaces},

    // The control program runs.
    ProgramTransition{S::running, E::control_link_lost, G::always, S::orphaned, A::close_control},
    ProgramTransition{S::running, E::sample, G::stopped, S::idle, A::close_control},
    ProgramTransition{S::running, E::sample, G::paused, S::ended, A::close_control},
    ProgramTransition{S::running, E::heartbeat_lost, G::always, S::foreign, A::close_control},

    // A script runs in its place.
    ProgramTransition{S::running, E::yield_requested, G::upload, S::yielding, A::suspend_program},
    ProgramTransition{S::yielding, E::yield_rejected, G::always, S::running, A::none},
    ProgramTransition{S::yielding, E::yield_failed, G::always, S::unclaimed, A::close_control},
    ProgramTransition{S::yielding, E::yield_canceled, G::always, S::unclaimed, A::close_control},
    ProgramTransition{S::yielding, E::program_yielded, G::always, S::yielded, A::none},
    ProgramTransition{S::yielded, E::resume_requested, G::always, S::resuming, A::none},
    ProgramTransition{S::yielded, E::script_replaced, G::stopped, S::idle, A::close_control},
    ProgramTransition{S::yielded, E::script_replaced, G::not_stopped, S::foreign, A::close_control},
    ProgramTransition{S::resuming, E::robot_ready, G::remote | G::stopped, S::resuming, A::start_program},
    ProgramTransition{S::resuming, E::robot_ready, G::remote | G::not_stopped, S::resuming, A::stop_program},
    ProgramTransition{S::resuming, E::program_started, G::always, S::running, A::none},
    ProgramTransition{S::resuming, E::start_failed, G::always, S::unclaimed, A::none},
    ProgramTransition{S::resuming, E::start_aborted, G::always, S::unclaimed, A::none},
    ProgramTransition{S::resuming, E::resume_blocked, G::always, S::unclaimed, A::none},
    ProgramTransition{S::resuming, E::inputs_in_use, G::always, S::in_use, A::close_interfaces},

    // The control program has ended.
    ProgramTransition{S::ended, E::sample, G::stopped, S::idle, A::none},
    ProgramTransition{S::ended, E::sample, G::playing, S::foreign, A::none},
    ProgramTransition{S::ended, E::inspection, G::paused, S::ended, A::stop_program},
    ProgramTransition{S::idle, E::sample, G::upload | G::not_stopped, S::foreign, A::none},
    ProgramTransition{S::idle, E::robot_ready, G::upload | G::restart | G::remote | G::stopped, S::restarting,
                      A::start_program},
    ProgramTransition{S::idle, E::inputs_in_use, G::upload, S::in_use_after_end, A::close_interfaces},
    ProgramTransition{S::foreign, E::sample, G::stopped, S::idle, A::none},
    ProgramTransition{S::foreign, E::inputs_in_use, G::upload, S::in_use_after_end, A::close_interfaces},

    // The restart.
    ProgramTransition{S::restarting, E::program_started, G::always, S::running, A::none},
    ProgramTransition{S::restarting, E::start_failed, G::always, S::restart_failed, A::none},
    ProgramTransition{S::restarting, E::start_aborted, G::always, S::idle, A::none},
    ProgramTransition{S::restarting, E::inputs_in_use, G::always, S::in_use_after_end, A::close_interfaces},
    ProgramTransition{S::restart_failed, E::inspection, G::stopped, S::idle, A::none},
    ProgramTransition{S::restart_failed, E::robot_ready, G::remote | G::not_stopped, S::restart_failed,
                      A::stop_program},
    ProgramTransition{S::restart_failed, E::inputs_in_use, G::always, S::in_use_after_end,
                      A::close_interfaces},

    // The External Control URCap fetches the control program; the operator starts it.
    ProgramTransition{S::idle, E::robot_ready, G::urcap | G::stopped, S::idle, A::connect_control},
    ProgramTransition{S::idle, E::robot_ready, G::urcap | G::playing, S::idle, A::adopt_program},
    ProgramTransition{S::idle, E::program_adopted, G::urcap, S::running, A::none},

    // Another driver has the robot, or has left its program.
    ProgramTransition{S::in_use, E::robot_ready, G::remote | G::stopped, S::starting, A::start_program},
    ProgramTransition{S::in_use, E::robot_ready, G::not_stopped, S::in_use, A::close_interfaces},
    ProgramTransition{S::in_use_after_end, E::robot_ready, G::restart | G::remote | G::stopped, S::restarting,
                      A::start_program},
    ProgramTransition{S::in_use_after_end, E::robot_ready, G::no_restart | G::stopped, S::idle, A::none},
    ProgramTransition{S::in_use_after_end, E::robot_ready, G::not_stopped, S::in_use_after_end,
                      A::close_interfaces},
};

struct ConditionName {
  G::Condition condition;
  const char * name;
};

constexpr std::array condition_names{
    ConditionName{G::upload, "upload"},           ConditionName{G::urcap, "control_urcap"},
    ConditionName{G::restart, "restart_program"}, ConditionName{G::no_restart, "no restart_program"},
    ConditionName{G::remote, "remote control"},   ConditionName{G::stopped, "stopped"},
    ConditionName{G::paused, "paused"},           ConditionName{G::playing, "playing"},
    ConditionName{G::not_stopped, "not stopped"},
};

}  // namespace

std::span<const ProgramTransition> program_transitions()
{
  return transitions;
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

bool ProgramStateMachine::allows(ProgramGuard guard, const ProgramObservation & observation) const
{
  const bool stopped = observation.program == ProgramActivity::stopped;
  const unsigned met =
      static_cast<unsigned>(mode_ == ControlMode::upload ? G::upload : G::urcap) |
      static_cast<unsigned>(restart_program_ ? G::restart : G::no_restart) |
      static_cast<unsigned>(observation.remote_control ? G::remote : G::always) |
      static_cast<unsigned>(stopped ? G::stopped : G::not_stopped) |
      static_cast<unsigned>(observation.program == ProgramActivity::paused ? G::paused : G::always) |
      static_cast<unsigned>(observation.program == ProgramActivity::playing ? G::playing : G::always);
  return (guard.conditions & ~met) == 0;
}

ProgramAction ProgramStateMachine::process(ProgramEvent event, const ProgramObservation & observation)
{
  for (const auto & transition : transitions) {
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
    case S::disconnected:
      return "disconnected";
    case S::program_lost:
      return "program_lost";
    case S::unclaimed:
      return "unclaimed";
    case S::orphaned:
      return "orphaned";
    case S::starting:
      return "starting";
    case S::running:
      return "running";
    case S::yielding:
      return "yielding";
    case S::yielded:
      return "yielded";
    case S::resuming:
      return "resuming";
    case S::ended:
      return "ended";
    case S::idle:
      return "idle";
    case S::foreign:
      return "foreign";
    case S::restarting:
      return "restarting";
    case S::restart_failed:
      return "restart_failed";
    case S::in_use:
      return "in_use";
    case S::in_use_after_end:
      return "in_use_after_end";
  }
  return "unknown";
}

const char * to_string(ProgramEvent event)
{
  switch (event) {
    case E::link_established:
      return "link_established";
    case E::link_lost:
      return "link_lost";
    case E::control_link_lost:
      return "control_link_lost";
    case E::sample:
      return "sample";
    case E::heartbeat_lost:
      return "heartbeat_lost";
    case E::inspection:
      return "inspection";
    case E::robot_ready:
      return "robot_ready";
    case E::program_started:
      return "program_started";
    case E::start_failed:
      return "start_failed";
    case E::start_aborted:
      return "start_aborted";
    case E::program_adopted:
      return "program_adopted";
    case E::inputs_in_use:
      return "inputs_in_use";
    case E::yield_requested:
      return "yield_requested";
    case E::yield_rejected:
      return "yield_rejected";
    case E::yield_failed:
      return "yield_failed";
    case E::yield_canceled:
      return "yield_canceled";
    case E::program_yielded:
      return "program_yielded";
    case E::resume_requested:
      return "resume_requested";
    case E::resume_blocked:
      return "resume_blocked";
    case E::script_replaced:
      return "script_replaced";
  }
  return "unknown";
}

const char * to_string(ProgramAction action)
{
  switch (action) {
    case A::none:
      return "none";
    case A::close_control:
      return "close_control";
    case A::close_interfaces:
      return "close_interfaces";
    case A::stop_program:
      return "stop_program";
    case A::start_program:
      return "start_program";
    case A::connect_control:
      return "connect_control";
    case A::adopt_program:
      return "adopt_program";
    case A::suspend_program:
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
