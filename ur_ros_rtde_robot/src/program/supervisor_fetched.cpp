// The control program that the External Control URCap fetches: somebody starts it on the pendant.
#include <fmt/format.h>

#include "program/supervisor.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds fetched_begin_limit(500);

RobotStatus not_running(std::string message)
{
  return {RobotState::stopped, ErrorCode::program_stopped, std::move(message)};
}

}  // namespace

void Supervisor::forget_program()
{
  left_running_ = left_running_ || fetched_ran_;
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
    left_running_ = false;
    begins_afresh_ = true;  // also if add() had seen it before forget_program()
  }
  if (sample.program_running() && !begins_afresh_) {
    // It may be in the middle of a motion. If it was ours it ends here, or by its watchdog.
    // A link that is lost meanwhile says nothing about the stop: it is looked at again with the next one.
    if (left_running_ && (stop_other_program(sample) || !still_linked(sample))) {
      return {RobotState::connecting, ErrorCode::not_ready, "stopping the program that the lost link left"};
    }
    return not_running(
        "a program runs on the robot that was started before the driver was connected: stop it, and start "
        "the one with the External Control node (on the pendant, or dashboard/play)");
  }
  if (!sample.program_running() && sample.runtime_state != RuntimeState::stopped) {
    return not_running(fmt::format(
        "a program of the robot is {}, and is not gone on with: stop it, and start the one with the "
        "External Control node (on the pendant, or dashboard/play)",
        to_string(sample.runtime_state)));
  }
  if (const auto prepared = links_.prepare_control(); !prepared) {
    return not_made(prepared.error());
  }
  return sample.program_running() ? take_over_fetched_program() : wait_for_play();
}

RobotStatus Supervisor::wait_for_play()
{
  return not_running(
      fmt::format("the control program does not run: start the program with the External Control node on the "
                  "pendant, or dashboard/play (in the URCap's installation: this host's address, port {})",
                  options_.urcap_port));
}

RobotStatus Supervisor::take_over_fetched_program()
{
  if (!links_.prepared_program_lives(fetched_begin_limit)) {
    return not_running(fmt::format(
        "a program runs on the robot, but not the control program: {}",
        server_->fetched() == 0
            ? fmt::format("nobody has fetched it from port {}. Is the host in the URCap's installation this "
                          "one, and has the program an External Control node?",
                          options_.urcap_port)
            : std::string(
                  "it has not come to its External Control node, or is past it; or it is another one")));
  }
  if (const auto taken = links_.take_prepared(); !taken) {
    return {RobotState::connecting, taken.error().code, taken.error().message};
  }
  begins_afresh_ = false;
  program_ended_ = false;
  program_ours_ = true;
  fetched_ran_ = true;
  return {RobotState::ready, ErrorCode::none, {}};
}

}  // namespace ur_ros_rtde
