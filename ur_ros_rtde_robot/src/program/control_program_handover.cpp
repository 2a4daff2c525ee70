// The hand-over of the robot between the control program and scripts, called by other threads.
#include "program/control_program_manager.hpp"

namespace ur_ros_rtde {
namespace {
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
}  // namespace

std::uint64_t ControlProgramManager::request_cycle()
{
  wake_ = true;
  changed_.notify_all();
  return ++requests_;
}

Status ControlProgramManager::yield(milliseconds timeout)
{
  const auto stop = stop_.get_token();
  const auto deadline = Clock::now() + timeout;
  std::unique_lock lock(mutex_);
  // After an end of the control program the status is still ready for a moment.
  changed_.wait_until(lock, stop, deadline, [this] {
    const auto state = machine_.state();
    return state == ProgramState::running || ur_ros_rtde::control_owner(state) == ControlOwner::script ||
           status_.state != RobotState::ready;
  });
  if (ur_ros_rtde::control_owner(machine_.state()) == ControlOwner::script) {
    return failure(ErrorCode::busy, "a script is running in place of the control program: wait for its end");
  }
  if (status_.state != RobotState::ready) {
    return failure(status_.cause, status_.message);
  }
  was_paused_ = false;
  process(ProgramEvent::yield_requested);
  const auto request = request_cycle();
  changed_.wait_until(lock, stop, deadline, [&] { return handled_ >= request; });
  if (machine_.state() == ProgramState::yielded) {
    return {};
  }
  process(ProgramEvent::yield_canceled);
  request_cycle();
  if (status_.state == RobotState::stopped || status_.state == RobotState::disconnected) {
    return failure(status_.cause, status_.message);
  }
  return failure(ErrorCode::program_stopped,
                 "something else ended the control program: the script was not sent");
}

Status ControlProgramManager::resume(milliseconds timeout)
{
  return resume_by(ProgramEvent::resume_requested, timeout);
}

Status ControlProgramManager::resume_after_replacement(milliseconds timeout)
{
  return resume_by(ProgramEvent::script_replaced, timeout);
}

std::shared_ptr<void> ControlProgramManager::hold()
{
  {
    const std::lock_guard lock(mutex_);
    ++holds_;
  }
  return {nullptr, [this](void *) {
            {
              const std::lock_guard lock(mutex_);
              --holds_;
            }
            changed_.notify_all();
          }};
}

Status ControlProgramManager::resume_by(ProgramEvent event, milliseconds timeout)
{
  std::unique_lock lock(mutex_);
  process(event);
  const auto request = request_cycle();
  if (!changed_.wait_for(lock, stop_.get_token(), timeout, [&] { return handled_ >= request; })) {
    return failure(ErrorCode::timeout, "the control program is still being started");
  }
  return status_.state == RobotState::ready ? Status() : failure(status_.cause, status_.message);
}

}  // namespace ur_ros_rtde
