// The control program that the External Control URCap fetches: somebody starts it on the pendant.
#include <fmt/format.h>

#include <utility>

#include "robot/dashboard_request.hpp"
#include "robot/supervisor.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds begin_limit(500);
constexpr milliseconds answer_limit(1000);
/// The controller fetches the program before it answers.
constexpr milliseconds play_limit(8000);
/// Later somebody may be at the arm who takes it for stopped.
constexpr milliseconds play_again_limit(10'000);

RobotStatus not_running(std::string message)
{
  return {RobotState::stopped, ErrorCode::program_stopped, std::move(message)};
}

}  // namespace

void Supervisor::forget_program()
{
  if (fetched_ran_) {
    play_again_ = options_.restart_program;
    lost_at_ = std::chrono::steady_clock::now();
  }
  fetched_ran_ = false;
  begins_afresh_ = false;
  program_ours_ = false;
}

bool Supervisor::still_linked(const Sample & sample) const
{
  const auto latest = state_.latest();
  return state_.link().connected && latest && latest->link == sample.link;
}

RobotStatus Supervisor::look_at_fetched_program(const Sample & sample)
{
  if (const auto serves = server_->status(); !serves) {
    return {RobotState::stopped, serves.error().code, serves.error().message};
  }
  if (sample.runtime_state == RuntimeState::stopped) {
    begins_afresh_ = true;  // also if add() had seen it before forget_program()
  }
  if (sample.program_running() && !begins_afresh_) {
    // It may be in the middle of a motion. If it was ours it ends here, or by its watchdog.
    // A link that is lost meanwhile says nothing about the stop: it is looked at again with the next one.
    play_again_ = play_again_ && (stop_other_program(sample) || !still_linked(sample));
    if (!play_again_) {
      return not_running(
          "a program runs on the robot that was started before the driver was connected: stop it, and start "
          "the one with the External Control node (on the pendant, or dashboard/play)");
    }
    return {RobotState::connecting, ErrorCode::not_ready, "starting the program of the robot again"};
  }
  if (!sample.program_running() && sample.runtime_state != RuntimeState::stopped) {
    return not_running(fmt::format(
        "a program of the robot is {}, and is not gone on with: stop it, and start the one with the "
        "External Control node (on the pendant, or dashboard/play)",
        to_string(sample.runtime_state)));
  }
  if (const auto prepared = links_.prepare_control(); !prepared) {
    return {RobotState::connecting, prepared.error().code, prepared.error().message};
  }
  return sample.program_running() ? take_over_fetched_program() : wait_for_play();
}

RobotStatus Supervisor::wait_for_play()
{
  if (std::exchange(play_again_, false)) {
    const auto played = play_again();
    if (played) {
      return {RobotState::connecting, ErrorCode::not_ready, "starting the program of the robot again"};
    }
    report_.say(LogLevel::warn, fmt::format("the program of the robot was ended by the lost link and is not "
                                            "started again: {}",
                                            played.error().message));
  }
  return not_running(
      fmt::format("the control program does not run: start the program with the External Control node on the "
                  "pendant, or dashboard/play (in the URCap's installation: this host's address, port {})",
                  options_.urcap_port));
}

RobotStatus Supervisor::take_over_fetched_program()
{
  play_again_ = false;  // somebody was faster
  if (!links_.prepared_program_lives(begin_limit)) {
    return not_running(fmt::format(
        "a program runs on the robot, but not the control program: {}",
        server_->fetched() == 0
            ? fmt::format("nobody has fetched it from port {}. Is the host in the URCap's installation this "
                          "one, and has the program an External Control node?",
                          options_.urcap_port)
            : std::string(
                  "it has not come to its External Control node, or is past it; or it is another one")));
  }
  const auto name =
      dashboard_request(options_.address, "get loaded program", answer_limit, stop_).value_or(std::string());
  if (const auto taken = links_.take_prepared(); !taken) {
    return {RobotState::connecting, taken.error().code, taken.error().message};
  }
  fetched_program_ = name;
  fetched_ran_ = true;
  begins_afresh_ = false;
  program_ended_ = false;
  program_ours_ = true;
  return {RobotState::ready, ErrorCode::none, {}};
}

Status Supervisor::play_again()
{
  if (std::chrono::steady_clock::now() - lost_at_ > play_again_limit) {
    return failure(ErrorCode::not_ready, "the link was away for longer than 10 s");
  }
  if (dashboard_.in_remote_control() == false) {
    return failure(ErrorCode::not_ready, "the robot is in local control");
  }
  const auto name = dashboard_request(options_.address, "get loaded program", answer_limit, stop_);
  if (!name) {
    return tl::unexpected(name.error());
  }
  if (fetched_program_.empty() || *name != fetched_program_) {
    return failure(ErrorCode::not_ready, fmt::format("another one is loaded ({})", *name));
  }
  const auto answer = dashboard_request(options_.address, "play", play_limit, stop_);
  if (!answer) {
    return tl::unexpected(answer.error());
  }
  if (!answer->starts_with("Starting program")) {
    return failure(ErrorCode::rejected_by_robot, fmt::format("the robot answered to `play`: {}", *answer));
  }
  return {};
}

}  // namespace ur_ros_rtde
