// The control interface of a program that the External Control URCap fetches and somebody else starts.
#include <fmt/format.h>
#include <ur_rtde/rtde_control_interface.h>

#include <utility>

#include "connection/interface_links.hpp"
#include "ur_ros_rtde_robot/connection/text.hpp"

namespace ur_ros_rtde {
namespace {

using Clock = std::chrono::steady_clock;
using ur_rtde::RTDEControlInterface;

}  // namespace

Status InterfaceLinks::prepare_control()
{
  {
    const std::lock_guard lock(mutex_);
    if (parked_ && parked_->isConnected()) {
      return {};
    }
  }
  drop_control();
  if (const auto reachable = reach_control_ports(); !reachable) {
    return reachable;
  }
  try {
    auto control = connect_control({});
    const std::lock_guard lock(mutex_);
    parked_ = std::move(control);
    return {};
  } catch (const std::exception & error) {
    return tl::unexpected(refused("the robot refuses the control interface", error));
  }
}

bool InterfaceLinks::prepared_program_lives(std::chrono::milliseconds limit) const
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = parked_;
  }
  // The first state that an interface receives counts as a sign of life: what comes after that tells.
  constexpr int states_in_patience = 15;
  constexpr std::chrono::milliseconds patience(50);
  const auto deadline = Clock::now() + limit;
  for (int states = 0; control && control->waitForNextState(); ++states) {
    if (states < states_in_patience) {
      continue;
    }
    if (control->getTimeSinceHeartbeat() < patience) {
      return true;
    }
    if (Clock::now() > deadline) {
      return false;
    }
  }
  return false;
}

Status InterfaceLinks::take_prepared()
{
  std::shared_ptr<RTDEControlInterface> control;
  {
    const std::lock_guard lock(mutex_);
    control = parked_;
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
    drop_control();
    return taken;
  }
  const std::lock_guard lock(mutex_);
  control_ = std::exchange(parked_, nullptr);
  return {};
}

}  // namespace ur_ros_rtde
