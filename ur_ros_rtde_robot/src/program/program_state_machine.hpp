#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ur_ros_rtde_robot/robot_options.hpp"
#include "ur_ros_rtde_robot/state/sample.hpp"

namespace ur_ros_rtde {

/// What is known about the program on the robot. docs/internals/control_program.md explains states and
/// transitions.
enum class ProgramState : std::uint8_t {
  disconnected,      ///< no RTDE connection
  program_lost,      ///< no RTDE connection; the control program ran when the connection was lost
  unclaimed,         ///< connected; the control program has not run since
  orphaned,          ///< connected; the program of a lost or closed connection, or a script, may still run
  starting,          ///< the control program is being started
  running,           ///< the control program runs and accepts commands
  yielding,          ///< the control program is being ended to run a script in its place
  yielded,           ///< a script has the robot
  resuming,          ///< the script has ended; the control program is being started again
  ended,             ///< the control program has ended, but has not been seen stopped: it may be paused
  idle,              ///< the control program has ended and was seen stopped
  foreign,           ///< another program has replaced the control program
  restarting,        ///< the control program is being started again after its end
  restart_failed,    ///< the restart failed: a program that runs is the control program
  in_use,            ///< another driver has, or had, the inputs of the robot
  in_use_after_end,  ///< the same, after the control program has ended
};
constexpr std::size_t program_state_count = 16;

enum class ProgramEvent : std::uint8_t {
  link_established,   ///< a sample of a new RTDE connection
  link_lost,          ///< the RTDE connection of the samples is lost
  control_link_lost,  ///< only the connection to the control program is lost
  sample,             ///< the newest sample shows ProgramObservation::program
  heartbeat_lost,     ///< a program runs, but without the heartbeat of the control program
  inspection,         ///< the manager examines the robot, in any condition
  robot_ready,        ///< nothing but the program on the robot prevents a start
  program_started,
  start_failed,     ///< the control program did not start or does not answer
  start_aborted,    ///< it was not sent: a connection failed, the robot cannot move, or another program has
                    ///< begun
  program_adopted,  ///< the program that the URCap started is the control program
  inputs_in_use,    ///< the controller rejected an interface: another client has its inputs
  yield_requested,
  yield_rejected,  ///< a condition of the robot prevents motion; nothing has been done
  yield_failed,    ///< the control program could not be ended, or was ended or paused by something else
  yield_canceled,  ///< the requester waits no longer
  program_yielded,
  resume_requested,
  resume_blocked,   ///< the robot cannot run the control program now
  script_replaced,  ///< the script has ended because another program took its place
};
constexpr std::size_t program_event_count = 20;

enum class ProgramAction : std::uint8_t {
  none,
  close_control,     ///< close the control interface
  close_interfaces,  ///< close the control and the IO interface
  stop_program,      ///< stop the program on the robot
  start_program,     ///< upload and start the control program
  connect_control,   ///< connect to a control program that the URCap will start
  adopt_program,     ///< take the running program over if it is the control program
  suspend_program,   ///< end the control program, keep its connection
};
constexpr std::size_t program_action_count = 8;

/// Who may run a program on the robot.
enum class ControlOwner : std::uint8_t {
  driver,
  script,  ///< from the request to yield until the control program is started again
};

constexpr ControlOwner control_owner(ProgramState state)
{
  return state == ProgramState::yielding || state == ProgramState::yielded || state == ProgramState::resuming
             ? ControlOwner::script
             : ControlOwner::driver;
}

/// RuntimeState, as far as the transitions distinguish it.
enum class ProgramActivity : std::uint8_t {
  stopped,
  paused,  ///< pausing, paused, resuming or stopping
  playing,
};

ProgramActivity program_activity(RuntimeState state);
/// Whether it is paused, or about to be: not ProgramActivity::paused, which includes programs that resume or
/// end.
bool is_pause(RuntimeState state);

struct ProgramObservation {
  ProgramActivity program = ProgramActivity::stopped;
  bool remote_control = true;  ///< the robot accepts programs; false in local control

  bool operator==(const ProgramObservation &) const = default;
};

/// All conditions of a transition that have to be met, as bits.
struct ProgramGuard {
  enum Condition : std::uint16_t {
    always = 0,
    upload = 1U << 0U,       ///< ControlMode::upload
    urcap = 1U << 1U,        ///< ControlMode::control_urcap
    restart = 1U << 2U,      ///< RobotOptions::restart_program
    no_restart = 1U << 3U,   ///< not RobotOptions::restart_program
    remote = 1U << 4U,       ///< ProgramObservation::remote_control
    stopped = 1U << 5U,      ///< ProgramObservation::program is stopped
    paused = 1U << 6U,       ///< … paused
    playing = 1U << 7U,      ///< … playing
    not_stopped = 1U << 8U,  ///< … paused or playing
  };
  std::uint16_t conditions = always;

  constexpr ProgramGuard() = default;
  constexpr ProgramGuard(unsigned all) : conditions(static_cast<std::uint16_t>(all)) {}  // NOLINT
};

struct ProgramTransition {
  ProgramState from;
  ProgramEvent event;
  ProgramGuard guard;
  ProgramState to;
  ProgramAction action;
};

/// The complete table. A pair of state and event that is not listed, or whose guard is not met, changes
/// nothing.
std::span<const ProgramTransition> program_transitions();

const char * to_string(ProgramState state);
const char * to_string(ProgramEvent event);
const char * to_string(ProgramAction action);
/// "upload, stopped"; empty for ProgramGuard::always.
std::string to_string(ProgramGuard guard);

/// Decides what happens to the program on the robot. Deterministic: without threads, I/O and clock.
class ProgramStateMachine {
 public:
  ProgramStateMachine(ControlMode mode, bool restart_program, ProgramState state = ProgramState::disconnected)
      : mode_(mode), restart_program_(restart_program), state_(state)
  {
  }

  ProgramState state() const { return state_; }
  /// Changes the state and returns what to do next.
  ProgramAction process(ProgramEvent event, const ProgramObservation & observation);

 private:
  bool allows(ProgramGuard guard, const ProgramObservation & observation) const;

  ControlMode mode_;
  bool restart_program_;
  ProgramState state_;
};

}  // namespace ur_ros_rtde
