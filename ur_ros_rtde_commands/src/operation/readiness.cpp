#include "operation/readiness.hpp"

#include <fmt/format.h>

#include "operation/dashboard_talk.hpp"

namespace ur_ros_rtde {
namespace {
/// A command that has not shown yet, or was refused for the moment, is given again after this.
constexpr std::chrono::milliseconds command_interval{1000};
/// The safety system takes seconds to restart, and shows nothing meanwhile: told again, it would begin anew.
constexpr std::chrono::milliseconds restart_interval{15000};

[[noreturn]] void for_people(ErrorCode code, std::string what)
{
  throw RobotError({code, std::move(what)});
}
}  // namespace

void Readiness::command(const std::string & line, const std::string & reply, std::chrono::milliseconds takes)
{
  const auto now = Clock::now();
  const auto interval = last_refusal_.empty() ? takes : command_interval;
  if (line == last_command_ && now - last_command_time_ < interval) {
    return;
  }
  last_command_ = line;
  last_command_time_ = now;
  const Status told = tell_dashboard(robot_, line, reply);
  last_refusal_ = told ? "" : "; " + told.error().message;
}

/// Whether one is open cannot be asked: they are closed once, and again after each safety stop.
void Readiness::close_popups()
{
  if (goal_.close_popups && !popups_closed_) {
    popups_closed_ = true;
    ask_dashboard(robot_, "close popup");
    ask_dashboard(robot_, "close safety popup");
  }
}

std::string Readiness::step()
{
  // The newest package may be older than what somebody has just switched off: the dashboard knows.
  if (robot_.ready_to_move() && dashboard_value(robot_, "robotmode") == "RUNNING" && robot_.ready_to_move()) {
    return {};
  }
  if (ask_dashboard(robot_, "is in remote control") == "false") {
    for_people(ErrorCode::not_ready,
               "the robot is in local control and takes no commands from here: choose remote control on the "
               "teach pendant (enabled under Settings, System, Remote Control), then try again");
  }
  const std::string safety = dashboard_value(robot_, "safetymode");
  if (safety != "NORMAL" && safety != "REDUCED") {
    popups_closed_ = false;
    return leave_safety_stop(safety);
  }
  close_popups();
  const std::string mode = dashboard_value(robot_, "robotmode");
  return mode == "RUNNING" ? start_program() : start_arm(mode);
}

std::string Readiness::leave_safety_stop(const std::string & mode)
{
  if (mode == "PROTECTIVE_STOP") {
    return unlock();
  }
  if (mode == "VIOLATION" || mode == "FAULT") {
    return restart_safety(mode);
  }
  if (mode == "ROBOT_EMERGENCY_STOP" || mode == "SYSTEM_EMERGENCY_STOP") {
    for_people(
        ErrorCode::emergency_stop,
        fmt::format("the robot is in an emergency stop ({}): find out why, release the button, then try "
                    "again",
                    mode));
  }
  if (mode == "SAFEGUARD_STOP" || mode == "AUTOMATIC_MODE_SAFEGUARD_STOP" ||
      mode == "SYSTEM_THREE_POSITION_ENABLING_STOP") {
    for_people(ErrorCode::safeguard_stop,
               fmt::format("the robot is in a safeguard stop ({}): close the guard or reset the safeguard "
                           "input, then try again",
                           mode));
  }
  if (mode == "RECOVERY") {
    for_people(ErrorCode::safety_violation,
               "the robot is in recovery mode, outside its safety limits: move it back inside on the teach "
               "pendant, then try again");
  }
  return fmt::format("waiting for safety mode NORMAL (it is {})", mode);
}

std::string Readiness::unlock()
{
  if (!goal_.unlock_protective_stop) {
    for_people(
        ErrorCode::protective_stop,
        "the robot is in a protective stop and unlock_protective_stop is false: remove what it ran into, "
        "then try again with true");
  }
  if (goal_.close_popups) {
    ask_dashboard(robot_, "close safety popup");
  }
  command("unlock protective stop", "Protective stop releasing", command_interval);
  return "unlocking the protective stop" + last_refusal_;
}

std::string Readiness::restart_safety(const std::string & mode)
{
  if (!goal_.restart_safety) {
    for_people(
        ErrorCode::safety_violation,
        fmt::format("the safety system reports a {} and restart_safety is false: look at the robot and at "
                    "the log on the teach pendant, then try again with true",
                    mode));
  }
  if (goal_.close_popups) {
    ask_dashboard(robot_, "close safety popup");
  }
  command("restart safety", "Restarting safety", restart_interval);
  return "restarting the safety system" + last_refusal_;
}

std::string Readiness::start_arm(const std::string & mode)
{
  if (mode == "CONFIRM_SAFETY") {
    for_people(ErrorCode::not_ready,
               "the safety configuration has to be confirmed on the teach pendant, then try again");
  }
  if (mode == "POWER_OFF") {
    command("power on", "Powering on", command_interval);
    return "powering on" + last_refusal_;
  }
  if (mode == "IDLE") {
    command("brake release", "Brake releasing", command_interval);
    return "releasing the brakes" + last_refusal_;
  }
  return fmt::format("waiting for the robot (mode {})", mode);
}

/// The supervisor starts it by itself, as soon as it has seen that the robot can move; what keeps it from
/// that for long is for people, too.
std::string Readiness::start_program()
{
  constexpr std::chrono::seconds patience{3};
  const RobotStatus status = robot_.status();
  const bool for_somebody = status.cause == ErrorCode::program_stopped ||
                            status.cause == ErrorCode::model_mismatch ||
                            status.cause == ErrorCode::robot_in_use;
  const bool kept = status.state == RobotState::stopped && for_somebody;
  if (!kept) {
    kept_since_.reset();
    return "starting the control program";
  }
  kept_since_ = kept_since_.value_or(Clock::now());
  if (Clock::now() - *kept_since_ > patience) {
    for_people(status.cause, status.message);
  }
  return "starting the control program; " + status.message;
}

}  // namespace ur_ros_rtde
