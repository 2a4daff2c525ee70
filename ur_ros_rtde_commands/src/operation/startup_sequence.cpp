#include "operation/startup_sequence.hpp"

#include <fmt/format.h>

#include <string_view>

#include "operation/dashboard_helpers.hpp"

namespace ur_ros_rtde {
namespace {
/// A command that was rejected or has had no effect yet is repeated after this time.
constexpr std::chrono::milliseconds command_interval{1000};
/// The safety system needs seconds to restart and does not report progress. A second command would start the
/// restart again.
constexpr std::chrono::milliseconds restart_interval{15000};

[[noreturn]] void require_operator(ErrorCode code, std::string what)
{
  throw RobotError({code, std::move(what)});
}
}  // namespace

void StartupSequence::command(const std::string & line, const std::string & reply,
                              std::chrono::milliseconds repeat_interval)
{
  const auto now = Clock::now();
  const auto interval = last_rejection_.empty() ? repeat_interval : command_interval;
  if (line == last_command_ && now - last_command_time_ < interval) {
    return;
  }
  last_command_ = line;
  last_command_time_ = now;
  last_rejection_.clear();  // unknown until the answer
  run_.unless_stopped([&] {
    const Status status = command_dashboard(dashboard_, line, reply);
    last_rejection_ = status ? "" : "; " + status.error().message;
  });
}

/// The dashboard server does not report open popups, so they are closed once and again after each safety
/// stop.
void StartupSequence::close_popups()
{
  if (goal_.close_popups && !popups_closed_) {
    send_to_dashboard(dashboard_, "close popup");
    send_to_dashboard(dashboard_, "close safety popup");
    popups_closed_ = true;
  }
}

/// A controller that is busy, for example with new firmware of the joints, answers late.
std::string StartupSequence::step()
{
  try {
    return next_step();
  } catch (const RobotError & error) {
    if (error.error().code != ErrorCode::timeout) {
      throw;
    }
    return "waiting for the dashboard server to answer";
  }
}

std::string StartupSequence::next_step()
{
  dashboard_ = DashboardSession(robot_.address());  // with the control mode, local or remote, of now
  // The newest package may be older than a change of the robot mode, so the dashboard server is queried, too.
  if (robot_.ready_to_move() && query_dashboard(dashboard_, "robotmode") == "RUNNING" &&
      robot_.ready_to_move()) {
    return {};
  }
  if (send_to_dashboard(dashboard_, "is in remote control") == "false") {
    require_operator(
        ErrorCode::not_ready,
        "the robot is in local control and accepts no remote commands: select remote control on the "
        "teach pendant (enabled under Settings, System, Remote Control), then try again");
  }
  const std::string safety = query_dashboard(dashboard_, "safetymode");
  if (safety != "NORMAL" && safety != "REDUCED") {
    popups_closed_ = false;
    return leave_safety_stop(safety);
  }
  close_popups();
  const std::string mode = query_dashboard(dashboard_, "robotmode");
  return mode == "RUNNING" ? start_program() : start_arm(mode);
}

std::string StartupSequence::leave_safety_stop(const std::string & mode)
{
  if (mode == "PROTECTIVE_STOP") {
    return unlock_protective_stop();
  }
  if (mode == "VIOLATION" || mode == "FAULT") {
    return restart_safety(mode);
  }
  const auto is_a = [&mode](std::string_view kind) { return mode.find(kind) != std::string::npos; };
  if (is_a("EMERGENCY_STOP")) {
    require_operator(
        ErrorCode::emergency_stop,
        fmt::format("the robot is in an emergency stop ({}): find the cause, release the button, then try "
                    "again",
                    mode));
  }
  if (is_a("SAFEGUARD_STOP") || is_a("ENABLING_STOP") || is_a("IO_PLANE_STOP")) {
    require_operator(
        ErrorCode::safeguard_stop,
        fmt::format("the robot is in a safeguard stop ({}): close the guard or reset the safeguard "
                    "input, then try again",
                    mode));
  }
  if (mode == "RECOVERY") {
    require_operator(
        ErrorCode::safety_violation,
        "the robot is in recovery mode, outside its safety limits: move it back inside on the teach "
        "pendant, then try again");
  }
  return fmt::format("waiting for safety mode NORMAL (it is {})", mode);
}

std::string StartupSequence::unlock_protective_stop()
{
  if (!goal_.unlock_protective_stop) {
    require_operator(
        ErrorCode::protective_stop,
        "the robot is in a protective stop and unlock_protective_stop is false: remove the obstacle, "
        "then try again with true");
  }
  if (goal_.close_popups) {
    send_to_dashboard(dashboard_, "close safety popup");
  }
  command("unlock protective stop", "Protective stop releasing", command_interval);
  return "unlocking the protective stop" + last_rejection_;
}

std::string StartupSequence::restart_safety(const std::string & mode)
{
  if (!goal_.restart_safety) {
    require_operator(
        ErrorCode::safety_violation,
        fmt::format("the safety system reports a {} and restart_safety is false: check the robot and "
                    "the log on the teach pendant, then try again with true",
                    mode));
  }
  if (goal_.close_popups) {
    send_to_dashboard(dashboard_, "close safety popup");
  }
  command("restart safety", "Restarting safety", restart_interval);
  return "restarting the safety system" + last_rejection_;
}

std::string StartupSequence::start_arm(const std::string & mode)
{
  if (mode == "CONFIRM_SAFETY") {
    require_operator(
        ErrorCode::not_ready,
        "the safety configuration is not confirmed: confirm it on the teach pendant, then try again");
  }
  if (mode == "POWER_OFF") {
    command("power on", "Powering on", command_interval);
    return "powering on" + last_rejection_;
  }
  if (mode == "IDLE") {
    command("brake release", "Brake releasing", command_interval);
    return "releasing the brakes" + last_rejection_;
  }
  return fmt::format("waiting for the robot (mode {})", mode);
}

/// The driver starts the control program itself as soon as the robot can move. Fails if the start is blocked
/// for 3 s by a cause that only an operator can remove.
std::string StartupSequence::start_program()
{
  constexpr std::chrono::seconds max_blocked{3};
  const RobotStatus status = robot_.status();
  const bool needs_operator = status.cause == ErrorCode::program_stopped ||
                              status.cause == ErrorCode::model_mismatch ||
                              status.cause == ErrorCode::robot_in_use;
  const bool blocked = status.state == RobotState::stopped && needs_operator;
  if (!blocked) {
    blocked_since_.reset();
    return "starting the control program";
  }
  blocked_since_ = blocked_since_.value_or(Clock::now());
  if (Clock::now() - *blocked_since_ > max_blocked) {
    require_operator(status.cause, status.message);
  }
  return "starting the control program; " + status.message;
}

}  // namespace ur_ros_rtde
