// How the control program gives way to a script and comes back.
#include <utility>

#include "motion/motion_stopper.hpp"
#include "program/supervisor.hpp"

namespace ur_ros_rtde {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds turn_end_limit(1000);

}  // namespace

bool Supervisor::gave_way() const
{
  return turn() != Turn::own;
}

void Supervisor::begin_look()
{
  const std::lock_guard lock(mutex_);
  turn_at_look_ = turn_;
  program_ended_ = program_ended_ || std::exchange(replaced_, false);
}

Supervisor::Turn Supervisor::turn() const
{
  const std::lock_guard lock(mutex_);
  return turn_;
}

Status Supervisor::give_way(milliseconds limit)
{
  std::unique_lock lock(mutex_);
  if (turn_ != Turn::own) {
    return failure(ErrorCode::busy, "a script is running in place of the control program: wait for its end");
  }
  if (status_.state != RobotState::ready) {
    return failure(status_.cause, status_.message);
  }
  turn_ = Turn::asked_for;
  look_requested_ = true;
  changed_.notify_all();
  changed_.wait_for(lock, limit, [this] { return turn_ != Turn::asked_for; });
  if (turn_ == Turn::others) {
    return {};
  }
  turn_ = Turn::own;
  if (status_.state != RobotState::ready) {
    return failure(status_.cause, status_.message);
  }
  return failure(ErrorCode::not_ready, "the control program does not give way to the script");
}

Status Supervisor::take_back(milliseconds limit, bool replaced)
{
  std::unique_lock lock(mutex_);
  turn_ = Turn::coming_back;
  replaced_ = replaced;
  look_requested_ = true;
  changed_.notify_all();
  const bool back = changed_.wait_for(lock, limit, [this] { return turn_ == Turn::own; });
  turn_ = Turn::own;
  if (!back) {
    return failure(ErrorCode::timeout, "the control program is still being started");
  }
  return status_.state == RobotState::ready ? Status() : failure(status_.cause, status_.message);
}

bool Supervisor::end_own_program(const Sample & sample)
{
  program_ours_ = false;  // from here on its end is no surprise
  links_.park_control();
  return wait_for_runtime(RuntimeState::stopped, turn_end_limit) || stop_other_program(sample);
}

RobotStatus Supervisor::look_at_turn(const Sample & sample, const std::optional<Error> & condition)
{
  if (turn_at_look_ == Turn::asked_for && !condition && end_own_program(sample)) {
    const std::lock_guard lock(mutex_);
    turn_ = turn_ == Turn::asked_for ? Turn::others : turn_;
  }
  if (const auto io = links_.ensure_io(); !io) {
    return not_made(io.error());
  }
  if (condition) {
    return {RobotState::stopped, condition->code, condition->message};
  }
  return {RobotState::ready, ErrorCode::none, {}};
}

void Supervisor::settle_turn(const RobotStatus & now)
{
  {
    const std::lock_guard lock(mutex_);
    if (turn_at_look_ == Turn::coming_back || (turn_ == Turn::asked_for && now.state != RobotState::ready)) {
      turn_ = Turn::own;
    }
    look_requested_ = look_requested_ || turn_ == Turn::asked_for || turn_ == Turn::coming_back;
  }
  changed_.notify_all();
}

}  // namespace ur_ros_rtde
