// Pending control interfaces: of a program that was suspended, or that the External Control URCap fetches and
// the operator starts.
#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "connection/rtde/rtde_interfaces.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
using ur_rtde::RTDEControlInterface;

constexpr std::chrono::milliseconds suspend_timeout(500);

}  // namespace

Status RtdeInterfaces::connect_pending_control()
{
  {
    const std::lock_guard lock(mutex_);
    if (pending_ && pending_->isConnected()) {
      return {};
    }
  }
  close_control();
  if (const auto reachable = probe_control_ports(); !reachable) {
    return reachable;
  }
  try {
    auto control = connect_control({});
    const std::lock_guard lock(mutex_);
    pending_ = std::move(control);
    return {};
  } catch (const std::exception & error) {
    return tl::unexpected(connection_error("the robot rejects the control interface", error));
  }
}

bool RtdeInterfaces::pending_program_alive(std::chrono::milliseconds timeout,
                                           const std::stop_token & stop) const
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = pending_;
  }
  // The first state that an interface receives counts as a heartbeat: only later ones are evidence.
  constexpr int ignored_states = 15;
  constexpr std::chrono::milliseconds heartbeat_timeout(50);
  const auto deadline = Clock::now() + timeout;
  for (int states = 0; control && control->waitForNextState(); ++states) {
    if (states < ignored_states) {
      continue;
    }
    if (control->isProgramRunning() && control->getTimeSinceHeartbeat() < heartbeat_timeout) {
      return true;
    }
    if (stop.stop_requested() || Clock::now() > deadline) {
      return false;
    }
  }
  return false;
}

Status RtdeInterfaces::adopt_control()
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = pending_;
  }
  Status taken = failure(ErrorCode::not_ready, "the connection to the control program was lost");
  try {
    if (control) {
      taken = start_watchdog(*control);
    }
  } catch (const std::exception & error) {
    taken = failure(ErrorCode::not_ready,
                    fmt::format("the control program cannot be taken over: {}", printable(error.what())));
  }
  if (!taken) {
    close_control();
    return taken;
  }
  const std::lock_guard lock(mutex_);
  activate(std::exchange(pending_, nullptr));
  return {};
}

bool RtdeInterfaces::suspend_control()
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = pending_ = activate(nullptr);
  }
  if (!control) {
    return false;
  }
  const HeldLock lock = take_control_lock(*control, suspend_timeout);
  if (!lock) {
    return false;
  }
  bool ended = false;
  try {
    control->setCommandTimeout(suspend_timeout);
    ended = control->stopScript();
  } catch (const std::exception &) {
    // The caller stops it by other means.
  }
  control->setCommandTimeout(std::chrono::seconds(UR_EXECUTION_TIMEOUT));
  return ended;
}

bool RtdeInterfaces::has_pending_control() const
{
  const std::lock_guard lock(mutex_);
  return pending_ != nullptr;
}

bool RtdeInterfaces::pending_program_plays() const
{
  const std::lock_guard lock(mutex_);
  return pending_ && pending_->isConnected() && pending_->isProgramRunning();
}

}  // namespace ur_ros_rtde
