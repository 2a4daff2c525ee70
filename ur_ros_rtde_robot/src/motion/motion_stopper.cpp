#include "motion/motion_stopper.hpp"

#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <array>

#include "connection/ports.hpp"
#include "motion/motion_blocker.hpp"
#include "state/wait_until.hpp"
#include "ur_ros_rtde_robot/connection/tcp_socket.hpp"

namespace ur_ros_rtde {
namespace {

using Control = ur_rtde::RTDEControlInterface;
using std::chrono::milliseconds;

constexpr std::uint32_t moves = Control::MOTION_MOVE_JOINT | Control::MOTION_MOVE_LINEAR;

/// Limits the time of a stop command, which is minutes by default.
class CommandLimit {
 public:
  CommandLimit(Control & control, milliseconds limit) : control_(control)
  {
    control_.setCommandTimeout(limit);
  }
  ~CommandLimit() { control_.setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT)); }
  CommandLimit(const CommandLimit &) = delete;
  CommandLimit & operator=(const CommandLimit &) = delete;

 private:
  Control & control_;
};

/// Sends the stop command of each kind of motion that was started. Servo and speed motions must end before
/// another command moves the arm.
void send_stops(Control & control, const StopOptions & options)
{
  const auto started = control.getStartedMotions();
  const auto has = [started](std::uint32_t kind) { return (started & kind) != 0; };
  if (has(Control::MOTION_SERVO)) {
    control.servoStop(options.linear_deceleration);
  }
  if (has(Control::MOTION_SPEED_JOINT)) {
    control.speedStop(options.joint_deceleration);
  }
  if (has(Control::MOTION_SPEED_LINEAR)) {
    control.speedStop(options.linear_deceleration);
  }
  if (has(Control::MOTION_FORCE)) {
    control.forceModeStop();
  }
  if (has(Control::MOTION_JOG)) {
    control.jogStop();
  }
  if (has(Control::MOTION_FREEDRIVE)) {
    control.endFreedriveMode();
  }
  if (has(Control::MOTION_TEACH)) {
    control.endTeachMode();
  }
  if (has(Control::MOTION_MOVE_JOINT)) {
    control.stopJ(options.joint_deceleration, true);
  }
  if (has(Control::MOTION_MOVE_LINEAR)) {
    control.stopL(options.linear_deceleration, true);
  }
  if (has(Control::MOTION_TORQUE)) {
    control.stopScript();
  }
}

}  // namespace

Status stop_program(const std::string & address, milliseconds limit)
{
  auto socket = TcpSocket::connect(address, dashboard_port, limit);
  if (!socket) {
    return tl::unexpected(socket.error());
  }
  const auto deadline = TcpSocket::Clock::now() + limit;
  if (const auto greeting = socket->read_line(deadline); !greeting) {
    return tl::unexpected(greeting.error());
  }
  if (const auto sent = socket->write("stop\n", deadline); !sent) {
    return sent;
  }
  const auto answer = socket->read_line(deadline);
  if (!answer) {
    return tl::unexpected(answer.error());
  }
  if (answer->find("Stopped") == std::string::npos) {
    return failure(ErrorCode::rejected_by_robot, fmt::format("the robot answered `stop` with: {}", *answer));
  }
  return {};
}

bool MotionStopper::is_moving() const
{
  const auto view = tracker_.view();
  if (!view.at_rest || view.operating()) {
    return true;
  }
  const auto control = interfaces_.control_interface();
  if (!control) {
    return false;
  }
  const auto started = control->getStartedMotions();
  // Includes a move that was sent but has not been acknowledged. Excludes a move that has ended.
  const bool move_pending =
      (started & moves) != 0 &&
      view.async.word == static_cast<std::uint32_t>(control->getAsyncStatusBeforeLastMove());
  return move_pending || (started & ~moves) != 0;
}

bool MotionStopper::command_stop(const StopOptions & options)
{
  const auto control = interfaces_.control_interface();
  if (!control) {
    return false;
  }
  // A blocking command holds the lock. When abandoned, it releases the lock at once, but the control program
  // may still be blocked.
  bool held = interfaces_.control_lock()->try_lock_for(milliseconds(20));
  for (int attempt = 0; !held && attempt < 10; ++attempt) {
    control->abandonCommand();
    held = interfaces_.control_lock()->try_lock_for(milliseconds(20));
  }
  if (!held) {
    return false;
  }
  const std::unique_ptr<InterfaceLock, void (*)(InterfaceLock *)> unlock(
      interfaces_.control_lock().get(), [](InterfaceLock * lock) { lock->unlock(); });
  try {
    const CommandLimit limit(*control, options.limit);
    send_stops(*control, options);
    return control->getStartedMotions() == 0;
  } catch (const std::exception &) {
    return false;
  }
}

bool MotionStopper::wait_for_standstill(milliseconds limit) const
{
  // The samples reflect commands with a delay of some cycles.
  constexpr std::uint64_t cycles = 5;
  const auto begin = tracker_.view().sequence;
  return wait_until(state_, limit, [&](const Sample &) {
    const auto view = tracker_.view();
    return view.sequence >= begin + cycles && view.at_rest && !view.operating();
  });
}

Expected<StopReport> MotionStopper::stop(const StopOptions & options)
{
  const std::lock_guard lock(mutex_);
  const auto sample = state_.latest();
  if (!state_.link().connected || !sample) {
    return link_lost();
  }
  const auto begin = tracker_.view().controller_time;
  const auto report = [&](StopMeans means) {
    return StopReport{means, tracker_.view().controller_time - begin};
  };
  if (!is_moving()) {
    return report(StopMeans::nothing_moved);
  }
  if (motion_blocker(*sample) || !sample->program_running()) {
    if (wait_for_standstill(options.program_stop_limit)) {
      return report(StopMeans::stopped_by_robot);
    }
  } else if (command_stop(options) && wait_for_standstill(options.limit)) {
    return report(StopMeans::stop_command);
  }
  const auto stopped = state_.link().connected ? stop_program(address_, milliseconds(500)) : Status();
  if (stopped && wait_for_standstill(options.program_stop_limit)) {
    return report(StopMeans::program_stopped);
  }
  interfaces_.close_control();  // ends the heartbeat, so that the watchdog stops the program
  if (wait_for_standstill(options.program_stop_limit)) {
    return report(StopMeans::program_stopped);
  }
  if (!state_.link().connected) {
    return link_lost();
  }
  return failure(ErrorCode::timeout,
                 fmt::format("all attempts to stop the arm have failed{}: use the emergency stop",
                             stopped ? "" : " (" + stopped.error().message + ")"));
}

tl::unexpected<Error> MotionStopper::link_lost() const
{
  return failure(ErrorCode::link_lost,
                 fmt::format("cannot tell the robot to stop: {}. The watchdog of its program stops it",
                             state_.link().error.message));
}

}  // namespace ur_ros_rtde
