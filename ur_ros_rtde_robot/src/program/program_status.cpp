#include "program/program_status.hpp"

#include <fmt/format.h>

#include <utility>

namespace ur_ros_rtde {
namespace {

RobotStatus upload_status(ProgramState state, const ProgramObservation & observation, bool restart_program)
{
  const bool in_use = state == ProgramState::in_use || state == ProgramState::in_use_after_end;
  if (in_use && observation.program != ProgramActivity::stopped) {
    return {RobotState::stopped, ErrorCode::robot_in_use,
            "another driver has left the robot, but not its program: if that does not end by itself, stop it "
            "(dashboard/stop, or on the pendant)"};
  }
  if (!observation.remote_control) {
    return {RobotState::stopped, ErrorCode::not_ready,
            "the robot is in local control and takes no program from here: choose remote control on the "
            "pendant (enabled under Settings, System, Remote Control)"};
  }
  if (state == ProgramState::foreign) {
    return program_stopped(
        fmt::format("another program {} on the robot and has replaced the control program: stop it "
                    "(dashboard/stop)",
                    observation.program == ProgramActivity::playing ? "runs" : "is paused or ending"));
  }
  if (state == ProgramState::idle && !restart_program) {
    return program_stopped(
        "the control program was stopped, and restart_program is off: start the driver again");
  }
  return {RobotState::connecting, ErrorCode::not_ready, "starting the control program"};
}

RobotStatus urcap_status(ProgramState state, const ProgramObservation & observation, RuntimeState runtime,
                         std::uint16_t port)
{
  constexpr const char * remedy =
      "stop it, and start the one with the External Control node (on the pendant, or dashboard/play)";
  switch (observation.program) {
    case ProgramActivity::playing:
      return program_stopped(
          state == ProgramState::foreign
              ? fmt::format("another program runs on the robot and has replaced the control program: {}",
                            remedy)
              : fmt::format(
                    "a program runs on the robot that was started before the driver was connected: {}",
                    remedy));
    case ProgramActivity::paused:
      return program_stopped(fmt::format("a program of the robot is {} and will not be resumed: {}",
                                         to_string(runtime), remedy));
    case ProgramActivity::stopped:
      break;
  }
  return program_stopped(
      fmt::format("the control program does not run: start the program with the External Control node on the "
                  "pendant, or dashboard/play (in the URCap's installation: this host's address, port {})",
                  port));
}

}  // namespace

const char * to_string(RobotState state)
{
  switch (state) {
    case RobotState::disconnected:
      return "disconnected";
    case RobotState::connecting:
      return "connecting";
    case RobotState::ready:
      return "ready";
    case RobotState::stopped:
      return "stopped";
  }
  return "unknown";
}

RobotStatus program_stopped(std::string message)
{
  return {RobotState::stopped, ErrorCode::program_stopped, std::move(message)};
}

RobotStatus stopped_by(const Error & error)
{
  return {RobotState::stopped, error.code, error.message};
}

Error stopped_by_watchdog(std::string_view program, double gap, double frequency, std::string_view more)
{
  return {ErrorCode::program_stopped,
          fmt::format("the watchdog of {} stopped it: this host sent no heartbeat for {:.0f} ms, at most "
                      "{:.0f} ms are allowed (watchdog_frequency); {}",
                      program, 1e3 * gap, 1e3 / frequency, more)};
}

RobotStatus program_status(ProgramState state, const ProgramObservation & observation, RuntimeState runtime,
                           const RobotOptions & options)
{
  return options.control_mode == ControlMode::upload
             ? upload_status(state, observation, options.restart_program)
             : urcap_status(state, observation, runtime, options.urcap_port);
}

}  // namespace ur_ros_rtde
